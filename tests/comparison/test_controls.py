"""Evaluation with controls: who is chosen among how many, and by which games they are judged."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.brains import genomes
from primordia.comparison import controls
from primordia.comparison.controls import evolved, unevolved
from primordia.errors import InputError
from primordia.history.founders import founders
from primordia.organism.evaluation import Evaluation
from primordia.organism.games import lifespans, play
from primordia.organism.players import founders_of
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from tests.commands import complains, here

LONG = 50
"""Ticks up to which founders live when the best is chosen."""


@pytest.fixture(scope="module")
def poles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Make two worlds in which poles fall."""
    folder = tmp_path_factory.mktemp("poles") / "run"
    settings = {"seeds": 2, "cells": 8, "stop": {"ticks": 500, "until": "none"}}
    return primordia.run("CartPole-survival", folder, saturation_ticks=LONG, **settings)


def test_each_world_has_a_champion_and_as_many_founders_as_births(poles: primordia.Run) -> None:
    run, lives = poles.opened(), poles.lives()
    champion, alive = evolved(run)
    best, some = unevolved(run)
    births = np.bincount(lives.world)
    assert champion.numbers == [(poles.oldest(world).id, world) for world in (0, 1)]
    living = np.flatnonzero(~lives.died)
    assert [world for _, world in alive.numbers] == lives.world[living].tolist()
    assert [number for number, _ in alive.numbers] == lives.id[living].tolist()
    assert champion.chosen_from == best.chosen_from == births.max() > 20
    assert [world for _, world in best.numbers] == [0, 1]
    assert len(some.numbers) == 2 * controls.TYPICAL
    assert alive.chosen_from == some.chosen_from == 1


def test_the_best_founder_is_the_last_of_the_longest_lived(poles: primordia.Run) -> None:
    run, most = poles.opened(), 20
    best, some = unevolved(run, most)
    for (number, world), chosen in zip(best.numbers, range(2), strict=True):
        keys = stream(
            wide(np.full(most, run.world_seeds[world])), Purpose.CONTROL, wide(np.arange(most))
        )
        rates = some.players.take(np.zeros(most, int)).rates
        made = founders(run, world, most)
        everyone = some.players._replace(genomes=made, keys=keys, rates=rates)
        lived = lifespans(everyone, LONG)
        assert number == max(np.flatnonzero(lived == lived.max()))
        assert lived.max() > np.median(lived)
        np.testing.assert_array_equal(best.players.genomes[chosen], made[number])


def test_no_game_that_chose_an_organism_judges_it(poles: primordia.Run) -> None:
    run = poles.opened()
    best, _ = unevolved(run, 30)
    world, everyone = founders_of(run, np.arange(2), np.full(2, 30))
    numbers = np.array([number for number, _ in best.numbers])
    chosen_ones = everyone.take(np.searchsorted(world, np.arange(2)) + numbers)
    np.testing.assert_array_equal(chosen_ones.genomes, best.players.genomes)
    choosing = play(chosen_ones, 1, LONG)
    judging = best.evaluate(games=5, ticks=LONG).evaluations
    for chosen, each in zip(choosing.course[:, 0], judging, strict=True):
        assert chosen not in each.lived.course


def test_founders_are_drawn_once_each_and_are_none_of_the_runs_own(poles: primordia.Run) -> None:
    run = poles.opened()
    some, more = founders(run, 0, 5), founders(run, 0, 300)
    np.testing.assert_array_equal(some, more[:5])
    assert len(np.unique(more, axis=0)) == 300
    first = poles.rebuild(0)
    assert not (more == first).all(axis=1).any()
    assert not (founders(run, 1, 5) == some).all(axis=1).any()
    assert more.std() == pytest.approx(first.std(), rel=0.3)


def test_founders_of_given_genomes_take_these(poles: primordia.Run, tmp_path: Path) -> None:
    poles.export(tmp_path / "two.safetensors", 0, 3)
    settings: Any = {
        "cells": 4,
        "stop": {"ticks": 20},
        "ancestors": (str(tmp_path / "two.safetensors"),),
    }
    run = primordia.run("CartPole-survival", tmp_path / "run", **settings).opened()
    given = genomes.read(settings["ancestors"], run.layout)
    made = founders(run, 0, 4)
    assert {each.tobytes() for each in made} == {each.tobytes() for each in given}


def test_quartiles_are_of_each_worlds_median_organism(poles: primordia.Run) -> None:
    _, alive, _, _ = poles.standings(10, games=3, ticks=60)
    median: dict[int, list[float]] = {}
    for each in alive.evaluations:
        assert isinstance(each, Evaluation)
        assert each.games == 1
        median.setdefault(each.world, []).append(float(each.lived.ticks[0]))
    values = [np.median(median[world]) for world in sorted(median)]
    assert alive.by_world("lifespan") == dict(zip(sorted(median), values, strict=True))
    assert alive.over_worlds("lifespan") == tuple(np.percentile(values, (50, 25, 75)))
    assert (alive.by_world("score"), alive.over_worlds("score")) == ({}, None)


def test_the_command_prints_what_python_gives(poles: primordia.Run) -> None:
    words = ["evaluate", poles.path, "--founders", 10, "--games", 2, "--ticks", 60]
    told = [each.to_dict() for each in poles.standings(10, games=2, ticks=60)]
    done = here(*words, "--json")
    assert json.loads(done.stdout) == {"rows": told}
    assert [each["games"] for each in told] == [2, 1, 2, 1]
    text = here(*words, "--world", 1).stdout
    names = [line.split()[0] for line in text.splitlines()[4:8]]
    assert names == ["champion", "all", "best", "founder"]
    complains(here(*words[:2], "--founders", 0), 2, "--founders")
    with pytest.raises(InputError, match="at least one founder"):
        poles.standings(0)
    complains(here(*words[:2], "--world", 2), 2, "there is no world 2")


def test_a_fork_has_no_champion_before_a_birth(poles: primordia.Run, tmp_path: Path) -> None:
    last = int(poles.lives().ended.max())
    fork = poles.fork(last, tmp_path / "fork", stop={"ticks": last})
    with pytest.raises(InputError, match="nothing has been born since the fork"):
        fork.standings()


def test_quartiles_are_those_over_worlds(monkeypatch: pytest.MonkeyPatch) -> None:
    values = {world: float(value) for world, value in enumerate((7, 1, 100, 3, 4))}
    monkeypatch.setattr(controls.Standing, "by_world", lambda self, outcome: values)
    assert controls.Standing("some", 1, []).over_worlds("lifespan") == (4.0, 3.0, 7.0)
