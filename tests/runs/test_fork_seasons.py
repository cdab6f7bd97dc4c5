"""Seasons of a fork: new ratchets look back as far as the fork, and no further; old ones go on.

Forks of invented worlds are tested here, and lives in forks with seasons in `test_fork`.
"""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax.numpy as jnp
import pytest

from primordia.errors import InputError
from primordia.law.metabolism import ONE
from primordia.law.world import Organisms, World, Worlds
from primordia.random.wide import to_host, wide
from primordia.runs import fork
from tests.runs.forking import COUNTS, adapted
from tests.worlds import HERD, MEADOW, config, law_of


def ratchet(above: float) -> dict[str, Any]:
    """Return a season that multiplies the drain by 2 if organisms gather more food than `above`."""
    return {"kind": "ratchet", "setting": "metabolism.drain", "when": "food", "above": above,
            "factor": 2.0, "every": 10}  # fmt: skip


def meadow(**more: Any) -> dict[str, Any]:
    return {**MEADOW, "seeds": 2, "metabolism": {"store": 1000.0, "drain": 0.25}, **more}


@pytest.mark.parametrize("setting", ["gain", "store", "drain", "effort_cost", "cap"])
def test_a_season_of_a_metabolism_that_there_is_not_is_refused(
    setting: str, tmp_path: Path
) -> None:
    season = {"kind": "schedule", "setting": f"metabolism.{setting}", "at": 5, "value": 1.0}
    with pytest.raises(InputError, match=rf"metabolism\.{setting}"):
        config(MEADOW, seasons=[season])
    assert config(MEADOW, seasons=[season], metabolism={"store": 9.0}).seasons
    (tmp_path / "config.toml").write_text(config(MEADOW).to_toml())
    source: Any = SimpleNamespace(path=tmp_path, config=SimpleNamespace(kept={}))
    with pytest.raises(InputError, match=rf"metabolism\.{setting}"):
        fork._fork_config(source, {"seasons": [season]}, 3)


def test_hunger_that_is_added_to_a_world_begins_with_full_stores() -> None:
    """So organisms that are alive at the fork starve together."""
    law, nothing = law_of(HERD), [None] * len(Organisms._fields)
    before: Any = SimpleNamespace(law=SimpleNamespace(beginning=()))
    after: Any = SimpleNamespace(law=law)
    climate = dict.fromkeys(law.rates, jnp.zeros(3))
    worlds: Any = Worlds(*[wide([9] * 3)] * len(Worlds._fields))
    worlds = worlds._replace(sample_wait=jnp.ones(3, int), climate=climate, calm=jnp.zeros(3, int))
    world = World(Organisms(*nothing), worlds)
    old, new = config(HERD, metabolism=None), config(HERD)
    energy = fork._adapt(world, before, after, old, new, 9).organisms.energy
    assert energy.tolist() == [400 * ONE] * 3 * 24


def looks_of(at: int, old: list[dict[str, Any]], new: list[dict[str, Any]]) -> Any:
    """Return the looks of a fork that has other seasons than before."""
    before, after = (config(meadow(seasons=seasons)) for seasons in (old, new))
    return adapted(at, before, after).looks


@pytest.mark.parametrize("at", [1, 20, 33, 70])
def test_each_new_ratchet_looks_at_multiples_of_its_period_and_counts_from_the_fork(
    at: int,
) -> None:
    """Three ratchets of two worlds."""
    looks = looks_of(at, [], [{**ratchet(0.4), "every": every} for every in (10, 7, 3)])
    assert looks.wait.tolist() == [[10 - at % 10, 7 - at % 7, 3 - at % 3]] * 2
    assert to_host(looks.food).tolist() == [[each] * 3 for each in COUNTS["food"]]
    assert to_host(looks.organism_ticks).tolist() == [
        [each] * 3 for each in COUNTS["organism_ticks"]
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
    adapted(10, config(meadow()), config(meadow(metabolism=changed)))
