"""A life lived again that differs from its record in any way is noticed; games count what is lived."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia.errors import Trouble
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.playing.evaluation import evaluate
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.runs.lives import ALIVE
from tests.worlds import CLOCKWORK, MEADOW, MILLS, config

HOST = {"name": "tests.toys:Mirror", "inner": "mill"}
Change = Callable[[RelivedLife], None]


@pytest.fixture(
    scope="module", params=["in JAX", pytest.param("on the host", marks=pytest.mark.slow)]
)
def mill(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Archive:
    """Make a run in which organisms die of hunger, of a broken wheel and by accident."""
    run = tmp_path_factory.mktemp("mill") / "run"
    habitat = HOST if request.param == "on the host" else MILLS["habitat"]
    loop.start(config({**MILLS, "habitat": habitat, "seed": 6, "stop": {"ticks": 400}}), run)
    return Archive(run)


def shifted(by: int) -> Change:
    def shift(life: RelivedLife) -> None:
        life.record.ended[0] += by

    return shift


def caused(cause: int) -> Change:
    def change(life: RelivedLife) -> None:
        if life.record.cause[0] == cause:  # so that each change is one
            cause_now = Cause.FATAL if cause != Cause.FATAL else Cause.STARVED
            life.record.cause[0] = cause_now
        else:
            life.record.cause[0] = cause

    return change


def left(energy: int, food: int) -> Change:
    def change(life: RelivedLife) -> None:
        before = life.at_death
        life.__dict__["at_death"] = before[0] + energy, before[1] + food

    return change


CHANGES = {
    "died a tick later": shifted(1),
    "died a tick earlier": shifted(-1),
    "died three ticks earlier": shifted(-3),
    "was struck by accident": caused(Cause.HAZARD),
    "broke": caused(Cause.FATAL),
    "failed": caused(Cause.FAULT),
    "lives": caused(ALIVE),
    "had more energy": left(1, 0),
    "had less energy": left(-1, 0),
    "ate more": left(0, 1),
    "ate less": left(0, -1),
}


@pytest.mark.parametrize("said", CHANGES)
def test_a_record_that_differs_from_the_life_is_noticed(mill: Archive, said: str) -> None:
    """The record says that the organism died otherwise than it does."""
    lives = mill.lives
    for cause in (Cause.STARVED, Cause.FATAL, Cause.HAZARD):
        row = int(np.flatnonzero((lives.cause == cause) & (lives.lifespan > 4))[0])
        life = RelivedLife.of(mill, int(lives.id[row]))
        assert len([*life.stretches()])
        CHANGES[said](life)
        with pytest.raises(Trouble, match="did not repeat as recorded"):
            list(life.stretches())


@pytest.mark.slow
def test_games_have_the_food_of_lives_and_the_latest_climate_of_their_world(tmp_path: Path) -> None:
    """Life becomes harder and then easier, so its end changes."""

    def season(setting: str, at: int, value: float) -> dict[str, Any]:
        return {"kind": "schedule", "setting": f"metabolism.{setting}", "at": at, "value": value}

    seasons = [season("drain", 50, 3.0), season("store", 60, 60.0), season("drain", 75, 6.5)]
    fed = {"habitat": {**MEADOW["habitat"], "food": 0.5}, "metabolism": {"store": 20.0}}
    settings = {**CLOCKWORK, **fed, "seasons": seasons}

    def played(ticks: int) -> tuple[list[int], list[float]]:
        loop.resume(tmp_path / "run", {"ticks": ticks})
        (found,) = evaluate(Archive(tmp_path / "run"), [(0, 1)], games=2)
        (cut,) = evaluate(Archive(tmp_path / "run"), [(0, 1)], games=2, ticks=9)
        assert (found.lived.over.all(), cut.to_dict()["alive_when_cut"]) == (True, 2)
        return found.lived.ticks.tolist(), found.lived.food.tolist()

    loop.start(config({**settings, "stop": {"ticks": 1}}), tmp_path / "run")
    assert played(45) == ([40] * 2, [20.0] * 2)
    run = Archive(tmp_path / "run")
    assert run.lives.lifespan[0] == 40
    assert RelivedLife.of(run, 0).at_death == (0, 20 * ONE)
    assert played(70) == ([24] * 2, [12.0] * 2)
    assert played(90) == ([10] * 2, [5.0] * 2)
