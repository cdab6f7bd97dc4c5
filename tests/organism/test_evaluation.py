"""An organism plays by itself: its lifespan, whole games, without seeing, and what the command says."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.errors import InputError
from primordia.organism import games
from primordia.organism.evaluation import evaluate
from primordia.organism.organism import Organism
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.commands import complains, here
from tests.worlds import MEADOW, config


@pytest.fixture(scope="module")
def pong(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("ale_py")
    run = tmp_path_factory.mktemp("pong") / "run"
    settings = {"cells": 6, "genesis": "fill", "mutation": {"founder_scale": 1.0}}
    return primordia.run(
        "Pong-survival", run, stop={"ticks": 400, "until": "none"}, **settings
    ).path


@pytest.fixture(scope="module")
def poles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("poles") / "run"
    return primordia.run("CartPole-survival", run, stop={"ticks": 3000, "until": "none"}).path


def test_where_nothing_is_random_a_life_is_lived_again(pong: Path) -> None:
    """To the tick, and one game is enough to know."""
    run = Archive(pong)
    everyone = run.lives
    died = np.flatnonzero(everyone.died)[:4]
    assert len(died) == 4
    played = primordia.load(pong).evaluate(Organism(run, row) for row in died)
    for row, found in zip(died, played, strict=True):
        assert (found.games, found.distinct) == (1, 1)
        assert found.lived.ticks[0] == everyone.lifespan[row]
        assert found.whole is not None
        assert found.whole.ticks[0] > everyone.lifespan[row]
        assert found.whole.food[0] <= -20


@pytest.mark.parametrize("senses", ["live", "frozen", "ignored"])
def test_side_by_side_each_plays_as_by_itself(
    poles: Path, monkeypatch: pytest.MonkeyPatch, senses: Any
) -> None:
    """However many there are, and however few find room at once."""
    some = [(0, 0), (7, 0), (3, 0), (11, 0), (7, 0)]
    monkeypatch.setattr(games, "AT_ONCE", 6)
    run = Archive(poles)
    together = evaluate(run, some, games=3, ticks=300, senses=senses)
    for each, found in zip(some, together, strict=True):
        (alone,) = evaluate(run, [each], games=3, ticks=300, senses=senses)
        assert found.lived.ticks.tolist() == alone.lived.ticks.tolist()
        assert found.lived.course.tolist() == alone.lived.course.tolist()
        assert np.array_equal(found.lived.actions[0], alone.lived.actions[0])
        assert found.to_dict() == alone.to_dict()
    assert len({found.lived.course[0] for found in together}) == 4
    assert evaluate(run, []) == []


def test_doing_it_again_blindly_comes_to_the_same(pong: Path) -> None:
    """In the same game, for as long as it lives; with buttons that stick it does not."""
    oldest = primordia.load(pong).oldest()
    live, ignored = oldest.evaluate(), oldest.evaluate(senses="ignored")
    assert live.lived.ticks == ignored.lived.ticks == oldest.age
    assert live.lived.course == ignored.lived.course
    assert np.array_equal(live.lived.actions[0], ignored.lived.actions[0])
    assert len(live.lived.actions[0]) == oldest.age
    sticky = oldest.evaluate(senses="ignored", games=3, sticky=0.5, noops=30)
    assert sticky.distinct == 3


def test_frozen_senses_are_those_of_the_start(tmp_path: Path) -> None:
    """One without memory who sees the clock stand still does the same thing over and over."""
    habitat, brain = {"name": "tests.toys:Watch"}, {"kind": "feed-forward"}
    settings = {**MEADOW, "stop": {"ticks": 5}, "habitat": habitat, "brain": brain}
    loop.start(config(settings), tmp_path / "run")
    run = Archive(tmp_path / "run")
    (live,) = evaluate(run, [(0, 0)], ticks=20)
    (frozen,) = evaluate(run, [(0, 0)], ticks=20, senses="frozen")
    assert live.lived.food[0] != frozen.lived.food[0]
    always = float(frozen.lived.actions[0][0, 0])
    assert frozen.lived.food[0] == pytest.approx(20 * always, rel=1e-5)


def test_games_begin_at_random_where_lives_do(poles: Path) -> None:
    found = primordia.load(poles).oldest().evaluate(games=12, ticks=2000)
    assert (found.games, found.distinct) == (12, 12)
    assert found.whole is None
    assert (found.lived.over | (found.lived.ticks == 2000)).all()
    again = primordia.load(poles).oldest().evaluate(games=12, ticks=2000)
    np.testing.assert_array_equal(found.lived.ticks, again.lived.ticks)


def test_it_starves_by_its_tasks_metabolism(tmp_path: Path) -> None:
    hungry = {"metabolism": {"store": 30.0, "gain": 0.5}, "stop": {"ticks": 10}}
    loop.start(
        config({**MEADOW, **hungry, "habitat": {**MEADOW["habitat"], "food": 1.0}}),
        tmp_path / "run",
    )
    run = Archive(tmp_path / "run")
    (found,) = evaluate(run, [(0, 0)], games=2)
    assert found.lived.ticks.tolist() == [60, 60]
    (cut,) = evaluate(run, [(0, 0)], games=2, ticks=59)
    assert not cut.lived.over.any()
    assert cut.to_dict()["alive_when_cut"] == 2


def test_what_the_command_says(pong: Path) -> None:
    one = here("evaluate", pong).stdout
    assert "1 distinct game; nothing is drawn at random" in one
    many = here("evaluate", pong, "--episodes", "3", "--sticky", "0.25", "--ticks", "300").stdout
    assert "3 games, sticky 0.25" in many
    assert "3 still going on when cut" in many
    told = json.loads(here("evaluate", pong, "--freeze-senses", "--json").stdout)
    assert (told["games"], told["senses"]) == (1, "frozen")
    assert set(told["score"]) == {"q1", "median", "q3", "maximum"}


def test_any_setting_of_the_habitat_is_a_flag(poles: Path) -> None:
    """Also one that has the name of an argument of `evaluate` in Python."""
    wide = here("evaluate", poles, "--ticks", "50", "--angle_limit", "180", "--track_limit", "1e9")
    assert "30 games, angle_limit 180, track_limit 1000000000.0" in wide.stdout
    assert "30 still alive when cut" in wide.stdout
    same = '["x", "x_dot", "theta", "theta_dot"]'
    told = here("evaluate", poles, "--episodes", "2", "--senses", same, "--json")
    plain = here("evaluate", poles, "--episodes", "2", "--json")
    assert json.loads(told.stdout)["lifespan"] == json.loads(plain.stdout)["lifespan"]


def test_help_on_a_run_lists_the_settings_of_its_habitat(pong: Path, poles: Path) -> None:
    told = here("evaluate", pong, "--help").stdout
    assert "--sticky" in told
    assert "probability that a frame repeats the last button [0.0]" in " ".join(told.split())
    assert "--angle_limit" in here("evaluate", poles, "--help").stdout
    assert "--sticky" not in here("evaluate", poles, "--help").stdout.partition("Options")[2]
    assert "Settings of the habitat" not in here("evaluate", "--help").stdout


def test_bad_input(pong: Path, poles: Path) -> None:
    for words, part in (
        ((poles, "--sticky", "0.1"), "this run's habitat has no setting 'sticky'"),
        ((poles, "--angle_limt", "9"), "did you mean 'angle_limit'?"),
        ((poles, "--angle_limit"), "--angle_limit needs a value"),
        ((poles, "--angle_limit", "-1"), "habitat.angle_limit"),
        ((pong, "--sticky", "1.5"), "sticky"),
        ((pong, "--open-loop", "--freeze-senses"), "one or the other"),
        ((pong, "--episodes", "0"), "one game or more"),
        ((pong, "--organism", "9999"), "no organism 9999"),
    ):
        complains(here("evaluate", *words), 2, part)


def test_the_brain_must_fit(pong: Path) -> None:
    with pytest.raises(InputError, match=r"3 senses and 2 actions; .* made for 3 and 6"):
        primordia.load(pong).oldest().evaluate(actions="NOOP UP")
