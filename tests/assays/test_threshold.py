"""The error threshold: p, v and s of worlds in which they are known."""

from types import SimpleNamespace
from typing import Any

import pytest

from primordia.assays.families import families
from primordia.assays.threshold import Threshold, threshold
from primordia.runs.lives import Lives
from tests.assays.lives import COPY, FOUNDER, MUTANT, lives


def measured(world: Lives, after: float = 0.0) -> Any:
    return threshold(SimpleNamespace(lives=world), after)[0]


def test_numbers_are_those_of_the_good_parents() -> None:
    """Of the good parent's 10 mutants 3 are as good; of the bad ones' mutants all are."""
    rows = [(-1, FOUNDER, 1000), *((-1, FOUNDER, 10) for _ in range(10))]
    rows += [(0, MUTANT, 1000)] * 3 + [(0, MUTANT, 10)] * 7 + [(0, COPY, 1000)] * 10
    rows += [(n, MUTANT, 10) for n in range(1, 11)] * 6
    found = measured(lives(*rows))
    mutants, children = 70, 80
    assert found.mutated == pytest.approx(mutants / children)
    assert found.as_good == pytest.approx(0.3)
    mean = sum(row[2] for row in rows) / len(rows)
    assert found.advantage == pytest.approx(1000 / mean)
    assert found.held == pytest.approx(found.advantage * (1 - found.mutated * (1 - found.as_good)))


def test_mutants_are_held_against_copies_where_chance_decides() -> None:
    """Half of the copies live as long as the parent, and so do half of the mutants: v is 1."""
    rows: list = [(-1, FOUNDER, 1000), *((-1, FOUNDER, 10) for _ in range(150))]
    for cause in (COPY, MUTANT):
        rows += [(0, cause, 1000)] * 5 + [(0, cause, 100)] * 5
    assert measured(lives(*rows)).as_good == 1
    assert measured(lives(*rows[:-1])).as_good is None  # nine mutants are too few


def test_what_is_alive_counts_once_it_is_known() -> None:
    rows: list = [
        (-1, FOUNDER, 100),
        (0, COPY, 100, "alive"),  # as old as its parent became
        (0, COPY, 99, "alive"),  # not known yet
        (-1, FOUNDER, 50, "alive"),
        (3, COPY, 49),  # shorter, whatever comes
        (3, COPY, 50),  # not known yet
    ]
    found = families(lives(*rows), 0.0)
    as_long, known = found.as_long()
    assert known.tolist() == [True, False, True, False]
    assert as_long[known].tolist() == [True, False]


def test_a_world_in_which_nothing_is_known_says_so() -> None:
    assert measured(lives((-1, FOUNDER, 5))) == Threshold(0, None, None, None)
    assert Threshold(0, 0.5, None, 2.0).held is None
    alive: list = [(-1, FOUNDER, 9, "alive"), (0, COPY, 5, "alive")]
    found = measured(lives(*alive))
    assert (found.as_good, found.advantage) == (None, None)


@pytest.mark.parametrize(
    ("p", "v", "s", "held"), [(0.5, 0, 2, 1), (0.1, 0, 1.2, 1.08), (1, 1, 3, 3)]
)
def test_the_threshold_is_eigens(p: float, v: float, s: float, held: float) -> None:
    assert Threshold(0, p, v, s).held == pytest.approx(held)
