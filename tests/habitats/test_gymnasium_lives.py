"""Lives in Gymnasium environments are exact whatever interrupts them; an error kills one organism."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from pyarrow.parquet import read_table

pytest.importorskip("gymnasium")

import primordia
from primordia.errors import InputError, Trouble
from primordia.habitats.gymnasium.habitat import Gymnasium
from primordia.testing import check_habitat
from tests.commands import here
from tests.ponds import CRASH
from tests.worlds import HOSTED, Lived, config

POND: dict[str, Any] = {
    "task": "pond",
    **HOSTED,
    "habitat": {
        "name": "gymnasium",
        "env": "tests.ponds:Pond-v0",
        "saving": "snapshot",
        "workers": 0,
    },
}


def pond(name: str = "Pond", **habitat: Any) -> dict[str, Any]:
    own = {**POND["habitat"], "env": f"tests.ponds:{name}-v0", **habitat}
    return {**POND, "habitat": own}


@pytest.mark.parametrize(
    ("name", "settings"),
    [
        pytest.param("Pond", {"saving": "replay", "workers": 2}, marks=pytest.mark.slow),
        ("Pond", {"saving": "restart", "time_limit": 7, "workers": 0}),
        (
            "Odd",
            {"saving": "snapshot", "squash": True, "scale": (50.0,), "time_limit": 7, "workers": 0},
        ),
        pytest.param("Closed", {"saving": "replay", "workers": 0}, marks=pytest.mark.slow),
        ("Worn", {"saving": "replay", "fresh": True, "workers": 0}),
    ],
)
def test_lives_keep_the_contract(name: str, settings: dict[str, Any]) -> None:
    check_habitat(Gymnasium(env=f"tests.ponds:{name}-v0", **settings))


@pytest.mark.parametrize(
    ("saving", "workers"),
    [("snapshot", 0), pytest.param("replay", 2, marks=pytest.mark.slow)],
)
def test_a_run_goes_on_from_its_arrays(saving: str, workers: int) -> None:
    """An engine with another pool of simulators takes the arrays of the first, and ends alike."""
    whole = Lived(config(pond(saving=saving)), 40)
    other = Lived(config(pond(saving=saving, workers=workers)), 1)
    other.engine.load(whole.engine.arrays())
    whole.advance_to(80)
    while other.engine.any_running(other.engine.limits({"ticks": 80})):
        other.engine.advance(other.engine.limits({"ticks": 80}))
    one, two = whole.engine.arrays(), other.engine.arrays()
    assert one["world.organisms.alive"].sum() > 3
    for name in one:
        if not name.startswith("bodies."):
            np.testing.assert_array_equal(one[name], two[name], err_msg=name)
    np.testing.assert_array_equal(one["bodies.senses"], two["bodies.senses"])


def test_death_food_effort_and_time_limit_are_settings() -> None:
    """Food by age: 2 + 4 + 6 + 8 until the limit at 4 ticks; effort is 1 a tick."""
    for food in ('2 * info["age"]', "tests.ponds:food"):
        habitat = pond(food=food, effort="1", time_limit=4, fatal="obs[0] > 100")
        lived = Lived(config(habitat, replication=0.0), 4)
        deaths = lived.table("deaths")
        assert set(deaths["cause"]) == {"time-limit"}
        np.testing.assert_array_equal(deaths["food"], 20.0)
        np.testing.assert_array_equal(deaths["energy"], 9 + 20 - 4)


def test_what_is_scored_has_the_reward_and_none_of_the_rules_of_lives() -> None:
    rules = {"fatal": "obs[0] < 100", "food": "2", "effort": "1", "time_limit": 4}
    calm = {"env": "tests.ponds:Pond-v0", "options": {"edge": 1e9}, "workers": 0}
    game = Gymnasium(**calm, **rules).original()
    game.open(1)
    game.reset(np.array([0]), np.array([[3]], np.uint32))
    for _ in range(8):
        _, outcome = game.step(np.ones((1, 1), np.float32), np.ones(1, bool))
        assert [outcome.fatal, outcome.expired, outcome.effort] == [False, False, 0]
        assert outcome.food == game.seen()["reward"].astype(np.float32)
    game.close()


def test_a_simulator_that_writes_to_standard_output_lives_as_a_quiet_one(capfd: Any) -> None:
    quiet, loud = (
        Lived(config(pond(name, saving="replay", workers=workers)), 20)
        for name, workers in (("Pond", 0), ("Splashing", 1))
    )
    assert loud.digests() == quiet.digests()
    out, err = capfd.readouterr()
    assert "splash" in err
    assert "splash" not in out


def test_an_error_kills_its_organism_and_leaves_its_last_line(tmp_path: Path, capfd: Any) -> None:
    task = {**pond("Crashing"), "stop": {"ticks": 60, "until": "none"}}
    (tmp_path / "pond.toml").write_text(tomli_w.dumps(task))
    run = primordia.run(str(tmp_path / "pond.toml"), tmp_path / "run")
    lines = (tmp_path / "run" / "faults.txt").read_text().splitlines()
    deaths = read_table(run.path / "deaths").to_pandas()
    failed = deaths[deaths.cause == "fault"]
    assert len(failed) == len(lines) > 3
    for line, (_, row) in zip(lines, failed.iterrows(), strict=True):
        who = f"world 0, organism {row['id']}, tick {row['tick']}"
        assert line == f"{who}: ZeroDivisionError: the pond is empty"
    assert "splash" not in "".join(capfd.readouterr())


@pytest.mark.parametrize("food", ["tests.ponds:food", "1 + 0 * obs[0]"])
def test_a_tick_that_fails_has_no_food_and_no_effort(food: str) -> None:
    game = Gymnasium(env="tests.ponds:Crashing-v0", food=food, effort="2 + reward", workers=0)
    game.open(1)
    game.reset(np.array([0]), np.array([[3]], np.uint32))
    for age in range(1, CRASH + 1):
        _, outcome = game.step(np.zeros((1, 1), np.float32), np.ones(1, bool))
        failed = age == CRASH
        assert outcome.fault == failed
        assert [bool(outcome.food), bool(outcome.effort)] == [not failed] * 2
    assert game.seen()["reward"] == 0
    game.close()


def test_a_life_that_cannot_begin_is_a_fault() -> None:
    lived = Lived(config(pond("Unborn")), 40)
    births, deaths = lived.table("births"), lived.table("deaths")
    born = dict(zip(births["id"], births["tick"], strict=True))
    failed = [k for k, cause in enumerate(deaths["cause"]) if cause == "fault"]
    assert failed
    assert all(deaths["tick"][k] == born[deaths["id"][k]] + 1 for k in failed)


def senses_and_faults(game: Gymnasium, word: int) -> list[tuple[bytes, bool]]:
    """Return senses and fault at each age of a life in the only cell, until the tick of an error."""
    seen = [(game.reset(np.array([0]), np.array([[word]], np.uint32)).tobytes(), False)]
    for _ in range(CRASH):
        senses, outcome = game.step(np.zeros((1, 1), np.float32), np.ones(1, bool))
        seen.append((senses.tobytes(), bool(np.any(outcome.fault))))
    return seen


def test_after_an_error_the_next_life_has_a_new_environment() -> None:
    """Each later life in the cell equals the same life in a new habitat."""
    words = range(2, 14, 2)
    one = Gymnasium(env="tests.ponds:Spoiled-v0", workers=0)
    one.open(1)
    after_others = [senses_and_faults(one, word) for word in words]
    one.close()
    alone = []
    for word in words:
        other = Gymnasium(env="tests.ponds:Spoiled-v0", workers=0)
        other.open(1)
        alone.append(senses_and_faults(other, word))
        other.close()
    assert after_others == alone
    assert {seen[-1][1] for seen in alone[:-1]} == {False, True}


def test_too_many_errors_stop_the_run() -> None:
    says = (
        r"\d organisms died of errors in tests.ponds:Crashing-v0, the last error: ZeroDivisionError"
    )
    with pytest.raises(Trouble, match=says):
        Lived(config(pond("Crashing", faults=2)), 200)


@pytest.mark.parametrize(
    ("habitat", "says"),
    [
        (
            {"env": "CartPoll-v1"},
            "cannot be made: Environment `CartPoll` doesn't exist. Did you mean",
        ),
        ({"env": "CartPole"}, "there is no CartPole; did you mean CartPole-v1?"),
        ({"env": "tests.ponds:Pond"}, "no tests.ponds:Pond; did you mean tests.ponds:Pond-v0?"),
        ({"env": "no_such_module:Env-v0"}, "No module named 'no_such_module'"),
        ({"env": "tests.ponds:Talking-v0"}, r"observation space\['says'\] is a Text"),
        ({"env": "tests.ponds:Still-v0"}, "its action space has no choice"),
        ({"fatal": "obs[2] > 1"}, r"obs goes from obs\[0\] to obs\[1\]"),
        ({"food": 'info["wage"]'}, "info has the parts age"),
        ({"food": "tests.ponds:drink"}, "food: tests.ponds:drink cannot be loaded"),
        ({"food": "tests.ponds:CRASH"}, "food: tests.ponds:CRASH is not a function"),
        ({"scale": [1.0, 2.0, 3.0]}, "scale: give 1 number or 2"),
        ({"scale": [0.0]}, "scale: give 1 number or 2 numbers, all above 0"),
        ({"scale": [1.0, -1.0]}, "scale: give 1 number or 2 numbers, all above 0"),
        ({"time_limit": 0}, "habitat.time_limit"),
        ({"faults": -1}, "habitat.faults"),
        ({"workers": -1}, "habitat.workers"),
        ({"options": {"depth": 3}}, "unexpected keyword argument 'depth'"),
    ],
)
def test_wrong_settings_are_one_line(habitat: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        config(pond(**habitat))
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_bodies_that_begin_again_are_those_of_the_births(monkeypatch: pytest.MonkeyPatch) -> None:
    words, reset = dict[int, list[int]](), Gymnasium.reset

    def noting(self: Gymnasium, cells: np.ndarray, given: np.ndarray) -> np.ndarray:
        words.update(zip(cells.tolist(), given.tolist(), strict=True))
        return reset(self, cells, given)

    monkeypatch.setattr(Gymnasium, "reset", noting)
    settings = config(pond("Hidden", saving="restart"), hazard=0.1, replication=0.5)
    before = Lived(settings, 20)
    organisms = before.engine.state.world.organisms
    alive = np.flatnonzero(organisms.alive)
    assert len(np.unique(np.asarray(organisms.born.lo)[alive])) > 2
    born = {cell: words[cell] for cell in alive.tolist()}
    after = Lived(settings, 1)
    words.clear()
    after.engine.load(before.engine.arrays())
    assert words == born


@pytest.mark.slow
def test_where_nothing_can_be_saved_bodies_begin_again_and_that_is_counted(tmp_path: Path) -> None:
    settings = {**HOSTED, "habitat": {"workers": 0}, "stop": {"ticks": 30}}
    run = primordia.run("gym:tests.ponds:Hidden-v0", tmp_path / "run", settings)
    before = run.lives()
    assert (run.info()["exact"], run.info()["restarts"]) == (False, 0)
    for times in (1, 2):
        run.resume(ticks=30 + 30 * times)
        assert run.info()["restarts"] == times
    assert "got new bodies 2 times" in here("info", run.path).stdout
    after = run.lives()
    np.testing.assert_array_equal(after.born[: len(before)], before.born)
