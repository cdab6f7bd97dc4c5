"""The genomes of a line of descent, born again."""

import numpy as np
import pytest

import primordia
from primordia.assays.line import Line, Step, line
from primordia.law.world import BirthCause
from primordia.organism.organism import Organism


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
    assert invented(10, 20).to_dict()["largest_step"] == [0, 1]


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


def test_the_last_genome_lives_as_in_an_evaluation(
    poles: primordia.Run, champion: Organism
) -> None:
    found = line(poles.opened(), champion.id, 1, games=3, ticks=300)
    evaluated = champion.evaluate(games=3, ticks=300)
    assert found.steps[-1].reborn == evaluated.lived.ticks.mean()


def test_a_long_line_is_sampled_from_end_to_end(poles: primordia.Run, champion: Organism) -> None:
    whole = line(poles.opened(), champion.id, 1, games=1, ticks=50)
    assert whole.genomes > 3
    some = line(poles.opened(), champion.id, 1, most=3, games=1, ticks=50)
    assert len(some.steps) == 3
    assert (some.steps[0], some.steps[-1]) == (whole.steps[0], whole.steps[-1])
    assert np.isin([s.organism for s in some.steps], [s.organism for s in whole.steps]).all()
    assert some.genomes == whole.genomes
