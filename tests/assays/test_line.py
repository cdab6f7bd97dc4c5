"""The genomes of a line of descent, born again."""

import json
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.assays import line as module
from primordia.assays.line import Line, Step, _changed, line
from primordia.assays.subjects import of_run
from primordia.law.world import BirthCause
from primordia.organism.organism import Organism
from primordia.organism.playing.games import Players
from primordia.random.wide import to_host
from tests.assays.lives import COPY, FOUNDER, MUTANT
from tests.assays.lives import lives as lives_of


def invented(*lives: float) -> Line:
    steps = [Step(n, n, n, "mutant", 1, life) for n, life in enumerate(lives)]
    return Line(len(lives) - 1, 0, len(lives) - 1, len(lives), steps)


def test_a_line_is_good_from_where_it_stays_good() -> None:
    assert invented(10, 95, 20, 90, 100).good.organism == 3
    assert invented(95, 100).good.organism == 0
    assert invented(100, 10, 50).good.organism == 2


def test_the_largest_step_is_the_largest_ratio() -> None:
    found = invented(10, 30, 20, 90, 100).largest
    assert found is not None
    assert [step.organism for step in found] == [2, 3]
    assert invented(10, 5, 5).largest is None
    assert invented(10, 20, 40).to_dict()["largest_step"] == [0, 1], "the first of equal steps"
    assert invented(10, 20).to_dict()["largest_step"] == [0, 1]


def test_brain_and_body_may_be_good_from_different_steps() -> None:
    lived = (10, 40, 80), (20, 85, 10), (90, 90, 90)
    steps = [
        Step(n, n + 5, n, "mutant", 1, reborn, brain=brain, body=body)
        for n, (reborn, brain, body) in enumerate(lived)
    ]
    found = Line(7, 0, 2, 3, steps)
    good = {part: step.organism for part, step in found.good_parts.items()}
    assert (found.good.organism, good) == (7, {"brain": 6, "body": 7})
    told = found.to_dict()
    assert (told["brain_good_from"], told["body_good_from"]) == (6, 7)
    assert invented(1, 2).good_parts == {}
    assert "body_good_from" not in invented(1, 2).to_dict()


@pytest.fixture(scope="module")
def champion(poles: primordia.Run) -> Organism:
    return poles.oldest(1)


def test_only_new_genomes_live(poles: primordia.Run, champion: Organism) -> None:
    run = poles.opened()
    found = line(run, champion.id, 1, games=2, ticks=300)
    ancestors = [poles.organism(each, 1) for each in champion.descent()]
    new = [each for each in ancestors if each.birth_cause != BirthCause.COPY.label]
    assert [step.organism for step in found.steps] == [each.id for each in new]
    assert found.generations == len(ancestors) - 1
    assert [step.recorded for step in found.steps] == [each.age for each in new]
    assert {step.birth_cause for step in found.steps[1:]} <= {"mutant"}
    evaluated = champion.evaluate(games=2, ticks=300)
    assert found.steps[-1].reborn == evaluated.lived.ticks.mean(), "as in an evaluation"
    assert json.dumps(found.to_dict()), "no numbers of NumPy"


def test_a_long_line_is_sampled_from_end_to_end(poles: primordia.Run, champion: Organism) -> None:
    whole = line(poles.opened(), champion.id, 1, games=1, ticks=50)
    assert whole.genomes > 3
    some = line(poles.opened(), champion.id, 1, most=3, games=1, ticks=50)
    assert len(some.steps) == 3
    assert (some.steps[0], some.steps[-1]) == (whole.steps[0], whole.steps[-1])
    assert some.steps[1] == whole.steps[(whole.genomes - 1) // 2], "they are evenly spaced"
    assert some.genomes == whole.genomes


def test_each_genome_plays_the_games_of_the_last_organism(
    poles: primordia.Run, champion: Organism, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each step has its own generation, tick of birth and lifespan. The lifespan when born again is the
    mean of its games. The recorded lifespan begins at birth, also if records begin later."""
    asked: list[tuple[Players, int, int]] = []

    def lived(players: Players, games: int, ticks: int) -> np.ndarray:
        asked.append((players, games, ticks))
        return np.add.outer(10 * np.arange(len(players.genomes)), np.arange(games))

    monkeypatch.setattr(module, "lifespans_in_games", lived)
    run = poles.opened()
    seen = np.minimum(run.lives.born + 2, run.lives.ended)
    monkeypatch.setitem(vars(run), "lives", replace(run.lives, seen=seen))
    found = line(run, champion.id, 1, games=4, ticks=88, habitat={"angle_limit": 5.0})
    ((players, games, ticks),) = asked
    assert (games, ticks) == (4, 88)
    own = of_run(poles.opened(), [(champion.id, 1)]).players
    stricter = of_run(poles.opened(), [(champion.id, 1)], {"angle_limit": 5.0}).players
    assert players.habitat == stricter.habitat != own.habitat
    assert (to_host(players.keys) == to_host(own.keys)).all()
    generation = {each: n for n, each in enumerate(champion.descent())}
    assert (found.organism, found.world, found.steps[-1].reborn) == (
        champion.id, 1, 10 * (len(found.steps) - 1) + 1.5
    )  # fmt: skip
    for k, (step, genome) in enumerate(zip(found.steps, players.genomes, strict=True)):
        organism = poles.organism(step.organism, 1)
        assert (step.generation, step.born) == (generation[step.organism], organism.born)
        assert (step.recorded, step.birth_cause) == (organism.age, organism.birth_cause)
        assert step.reborn == 10 * k + 1.5
        np.testing.assert_array_equal(genome, organism.genome())
    monkeypatch.setattr(Players, "deterministic", True)
    line(run, champion.id, 1, games=4, ticks=88)
    assert [games for _, games, _ in asked] == [4, 1], "a game without chance is played once"


def test_copies_of_one_parent_have_no_new_genome() -> None:
    """The first organism on record has a new genome even if it is a copy; so has a child of two."""
    lives = lives_of(
        (-1, FOUNDER, 9), (0, COPY, 9), (1, COPY, 9), (2, MUTANT, 9), (3, COPY, 9), (4, COPY, 9)
    )
    mates = np.array([-1, -1, 0, -1, -1, -1])
    run: Any = SimpleNamespace(lives=lives, mates_of=lambda some: mates[some.id])
    assert _changed(run, np.arange(6)).tolist() == [0, 2, 3]
    assert _changed(run, np.array([1, 2, 4, 5])).tolist() == [0, 1]
    assert _changed(run, np.array([4, 5])).tolist() == [0]
