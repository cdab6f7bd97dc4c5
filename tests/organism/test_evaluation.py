"""Evaluation: lifespans, whole games, games without sight, and the output of the command."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.cli.evaluate import _quartiles
from primordia.law.metabolism import ONE
from primordia.organism.playing import games
from primordia.organism.playing.evaluation import Spread, evaluate
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.worlds import CLOCKWORK, MEADOW, config


def test_organisms_play_side_by_side_as_they_play_alone(
    poles: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """This holds for any number of organisms, and for any number that play at once. They play blind."""
    some = [(0, 0), (7, 0), (3, 0), (11, 0), (7, 0)]
    monkeypatch.setitem(games.AT_ONCE, "jax", 6)
    run = Archive(poles)
    together = evaluate(run, some, games=3, ticks=300, senses="ignored")
    for each, evaluation in zip(some, together, strict=True):
        (alone,) = evaluate(run, [each], games=3, ticks=300, senses="ignored")
        assert evaluation.lived.ticks.tolist() == alone.lived.ticks.tolist()
        assert evaluation.lived.course.tolist() == alone.lived.course.tolist()
        assert np.array_equal(evaluation.lived.actions[0], alone.lived.actions[0])
        assert evaluation.to_dict() == alone.to_dict()
    assert len({evaluation.lived.course[0] for evaluation in together}) == 4
    assert evaluate(run, []) == []


def test_blind_players_repeat_a_game_that_is_not_judged(poles: Path) -> None:
    """The actions repeated are those of no game that the seeing player is judged by.

    In a changed habitat it still repeats the actions of a game of its own task.
    """
    falls = primordia.load(poles).organism(0)
    live, ignored = (
        falls.evaluate(games=3, ticks=300, senses=each) for each in ("live", "ignored")
    )
    assert not (live.lived.course == ignored.lived.course).any()
    repeated, seen = ignored.lived.actions[0], live.lived.actions[0]
    assert not np.array_equal(repeated, seen)
    changed = falls.evaluate(games=3, ticks=300, senses="ignored", spread=0.1).lived.actions[0]
    both = min(len(changed), len(repeated))
    assert np.array_equal(changed[:both], repeated[:both])


@pytest.mark.slow
def test_frozen_senses_stay_as_they_are_at_the_start(tmp_path: Path) -> None:
    """An organism without memory that sees a frozen clock repeats one action."""
    habitat, brain = {"name": "tests.toys:Watch"}, {"kind": "feed-forward"}
    settings = {**MEADOW, "stop": {"ticks": 5}, "habitat": habitat, "brain": brain}
    loop.start(config(settings), tmp_path / "run")
    run = Archive(tmp_path / "run")
    (live,) = evaluate(run, [(0, 0)], ticks=20)
    (frozen,) = evaluate(run, [(0, 0)], ticks=20, senses="frozen")
    assert live.lived.food[0] != frozen.lived.food[0]
    always = float(frozen.lived.actions[0][0, 0])
    assert frozen.lived.food[0] == pytest.approx(20 * always, rel=1e-5)


def test_games_start_at_random_where_lives_do(poles: Path) -> None:
    evaluation = primordia.load(poles).oldest().evaluate(games=12, ticks=2000)
    assert (evaluation.games, evaluation.distinct) == (12, 12)
    assert evaluation.whole is None
    assert (evaluation.lived.over | (evaluation.lived.ticks == 2000)).all()
    again = primordia.load(poles).oldest().evaluate(games=12, ticks=2000)
    np.testing.assert_array_equal(evaluation.lived.ticks, again.lived.ticks)


def test_a_number_alone_means_that_all_games_have_it() -> None:
    some, every = np.array([20] * 7 + [100] * 23), np.full(30, 100)
    text = "median 100 (quartiles 100, 100), minimum 20, maximum 100"
    assert _quartiles(Spread.of(some)._asdict()) == text
    assert _quartiles(Spread.of(every)._asdict()) == "100"


def test_any_setting_of_the_habitat_is_a_flag(poles: Path) -> None:
    """This holds also for a setting with the name of an argument of `evaluate` in Python."""
    organism = "--organism", str(primordia.load(poles).oldest(0).id)
    senses = "--senses", '["x", "x_dot", "theta", "theta_dot"]'
    changes = "--angle_limit", "180", "--track_limit", "1e9", *senses
    wide = here("evaluate", poles, *organism, "--ticks", "50", *changes)
    assert "30 games, angle_limit 180, track_limit 1000000000.0" in wide.stdout
    assert "30 still alive when cut" in wide.stdout


def test_help_on_a_run_lists_the_settings_of_its_habitat(poles: Path, mill: Path) -> None:
    printed = " ".join(here("evaluate", poles, "--help").stdout.split())
    assert "fatal angle, degrees [12.0]" in printed
    assert "--angle_limit" in printed
    assert "--angle_limit" not in here("evaluate", mill, "--help").stdout
    assert "Settings of the habitat" not in here("evaluate", "--help").stdout


def test_wrong_input_is_an_error_that_says_why(poles: Path) -> None:
    for words, part in (
        (("--sticky", "0.1"), "this run's habitat has no setting 'sticky'"),
        (("--angle_limt", "9"), "did you mean 'angle_limit'?"),
        (("--angle_limit",), "--angle_limit needs a value"),
        (("--angle_limit", "-1"), "habitat.angle_limit"),
        (("--open-loop", "--freeze-senses"), "exclude each other"),
        (("--organism", 0, "--founders", 500), "exclude each other"),
        (("--games", "0"), "--games"),
        (("--organism", "9999999"), "no organism 9999999"),
    ):
        complains(here("evaluate", poles, *words), 2, part)


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
