"""Seasons of a fork: its ratchets look back as far as the fork, and no further."""

from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.errors import InputError
from primordia.random.wide import to_host
from primordia.runs import loop
from tests.runs.forking import COUNTS, adapted
from tests.worlds import MEADOW, config

AT = 40


def ratchet(above: float) -> dict[str, Any]:
    """Return a season that multiplies the drain by 2 if organisms gather more food than `above`."""
    return {"kind": "ratchet", "setting": "metabolism.drain", "when": "food", "above": above,
            "factor": 2.0, "every": 10}  # fmt: skip


def meadow(food: float, **more: Any) -> dict[str, Any]:
    habitat = {**MEADOW["habitat"], "food": food}
    rest = {"brain": {"hidden": 1}, "replication": 0.1, "seeds": 2, "sample_every": 5}
    metabolism = {"metabolism": {"store": 1000.0, "drain": 0.25}}
    return {**MEADOW, **rest, **metabolism, "habitat": habitat, "stop": {"ticks": AT}, **more}


def test_a_new_ratchet_counts_food_since_the_fork(tmp_path: Path) -> None:
    """Before the fork the meadow had no food."""
    loop.start(config(meadow(0.0)), tmp_path / "run")
    changes = {"habitat": {"food": 1.0}, "seasons": [ratchet(0.9)], "stop": {"ticks": AT + 25}}
    fork = primordia.load(tmp_path / "run").fork(AT, tmp_path / "fork", **changes)
    metrics = fork.arrays("metrics")
    for world in range(2):
        here = (metrics["world"] == world) & (metrics["tick"] > AT)
        values = metrics["metabolism.drain"][here]
        drain = dict(zip(metrics["tick"][here].tolist(), values, strict=True))
        assert [drain[AT + later] for later in (5, 10, 15, 20)] == [0.25, 0.5, 0.5, 1.0]


def test_an_old_ratchet_goes_on_looking_back_to_its_last_look(tmp_path: Path) -> None:
    """The fork is between two looks, at ticks 20 and 40; food ends with it."""
    seasons = [{**ratchet(0.4), "every": 20},
               {**ratchet(0.6), "every": 20, "setting": "metabolism.store"}]  # fmt: skip
    still = {"replication": 0.0, "genesis": "fill", "stop": {"ticks": 30}}
    loop.start(config(meadow(1.0, seasons=seasons, **still)), tmp_path / "run")
    changes = {"habitat": {"food": 0.0}, "stop": {"ticks": 65}}
    fork = primordia.load(tmp_path / "run").fork(30, tmp_path / "fork", **changes)
    metrics = fork.arrays("metrics")
    here = metrics["world"] == 1
    for setting, first, turns in (("drain", 0.25, [2, 4, 4]), ("store", 1000.0, [2, 2, 2])):
        values = metrics[f"metabolism.{setting}"][here].tolist()
        now = dict(zip(metrics["tick"][here].tolist(), values, strict=True))
        assert [now[tick] for tick in (35, 40, 60)] == [first * times for times in turns]


@pytest.mark.parametrize("setting", ["gain", "store", "drain", "effort_cost", "cap"])
def test_a_season_of_a_metabolism_that_there_is_not_is_refused(
    setting: str, tmp_path: Path
) -> None:
    season = {"kind": "schedule", "setting": f"metabolism.{setting}", "at": 5, "value": 1.0}
    with pytest.raises(InputError, match=rf"metabolism\.{setting}"):
        config(MEADOW, seasons=[season])
    assert config(MEADOW, seasons=[season], metabolism={"store": 9.0}).seasons
    if setting == "gain":
        loop.start(config(MEADOW, brain={"hidden": 1}, stop={"ticks": 5}), tmp_path / "run")
        with pytest.raises(InputError, match=r"metabolism\.gain"):
            primordia.load(tmp_path / "run").fork(3, tmp_path / "fork", seasons=[season])


def looks_of(at: int, old: list[dict[str, Any]], new: list[dict[str, Any]]) -> Any:
    """Return the looks of a fork that has other seasons than before."""
    before, after = (config(meadow(1.0, seasons=seasons)) for seasons in (old, new))
    return adapted(at, before, after).looks


@pytest.mark.parametrize("at", [1, 20, 33, 70])
def test_each_new_ratchet_looks_at_multiples_of_its_period_and_counts_from_the_fork(
    at: int,
) -> None:
    looks = looks_of(at, [], [ratchet(0.4), {**ratchet(0.4), "every": 7}])
    assert looks.wait.tolist() == [[10 - at % 10, 7 - at % 7]] * 2
    assert to_host(looks.food).tolist() == [[each] * 2 for each in COUNTS["food"]]
    assert to_host(looks.organism_ticks).tolist() == [
        [each] * 2 for each in COUNTS["organism_ticks"]
    ]


@pytest.mark.parametrize(
    ("old", "new", "changed"),
    [
        ([ratchet(0.4)], [ratchet(0.4)], False),
        ([ratchet(0.4)], [ratchet(0.5)], True),
        ([ratchet(0.4)], [], True),
        ([], [ratchet(0.4)], True),
        ([ratchet(0.4), ratchet(0.5)], [ratchet(0.5), ratchet(0.4)], True),
    ],
)
def test_ratchets_begin_to_count_at_the_fork_if_any_season_has_changed(
    old: list[dict[str, Any]], new: list[dict[str, Any]], changed: bool
) -> None:
    looks = looks_of(10, old, new)
    if changed:
        assert looks.wait.tolist() == [[10] * len(new)] * 2
    else:
        assert looks == "looks", "they are unchanged"


@pytest.mark.parametrize(
    "changed", [{"store": 9.0}, {"store": 1000.0, "drain": 0.5}, {"store": 1000.0, "cap": 2e3}]
)
def test_a_changed_metabolism_fills_no_store(changed: dict[str, float]) -> None:
    """All organisms keep their energy, as `adapted` asserts of every fork."""
    adapted(10, config(meadow(1.0)), config(meadow(1.0, metabolism=changed)))
