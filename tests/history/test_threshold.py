"""The error threshold: p, v and s of worlds in which they are known."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.history.families import families
from primordia.history.threshold import Threshold, over_births, threshold
from primordia.runs.lives import Lives, joined
from tests.assays.lives import COPY, FOUNDER, MUTANT, lives


def run_of(lives: Lives, act: object = None) -> Any:
    return SimpleNamespace(lives=lives, config=SimpleNamespace(act=act))


def measured(world: Lives, after: float = 0.0, act: object = None) -> Any:
    return threshold(run_of(world, act), after)[0]


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


def test_ticks_of_the_living_count_in_the_ticks_lived_per_death() -> None:
    """Two copies are alive at three times the age at which their parent died."""
    copies: list = [(0, COPY, 100)] * 10 + [(0, COPY, 300, "alive")] * 2
    mutants: list = [(0, MUTANT, 100)] * 5 + [(0, MUTANT, 1)] * 5 + [(0, MUTANT, 40, "alive")] * 3
    others: list = [(-1, FOUNDER, 1)] * 200 + [(-1, FOUNDER, 20, "alive")] * 50
    found = measured(lives((-1, FOUNDER, 100), *copies, *mutants, *others))
    of_copies = (10 * 100 + 2 * 300) / 10
    of_all = (100 + 10 * 100 + 2 * 300 + 5 * 100 + 5 * 1 + 3 * 40 + 200 * 1 + 50 * 20) / 221
    assert found.advantage == pytest.approx(of_copies / of_all)
    assert found.held == pytest.approx(of_copies / of_all * (1 - 13 / 25 * (1 - 0.5)))


def test_children_take_the_place_of_lifespans_where_organisms_choose_when_to_copy() -> None:
    """A founder has 40 children, 20 copies and 20 mutants; of these, 10 and 4 have as many children.

    All live equally long, so there is no advantage in lifespan.
    """
    rows: list = [(-1, FOUNDER, 10), *[(0, COPY, 10)] * 20, *[(0, MUTANT, 10)] * 20]
    for parent in (*range(1, 11), *range(21, 25)):
        rows += [(parent, COPY, 10)] * 40
    world = lives(*rows)
    found = measured(world, act="act")
    children = 40 + 14 * 40
    assert found.mutated == pytest.approx(20 / children)
    assert found.as_good == 1  # the copies of the last generation have no children yet
    assert measured(world).advantage == pytest.approx(1)
    edges = np.array([0, 41])
    (early,) = over_births(0, world, edges, acts=True)
    assert early.as_good == pytest.approx((4 / 20) / (10 / 20))
    assert early.advantage == pytest.approx((10 * 40 / 20) / (children / 41))


def test_a_world_in_which_nothing_is_known_says_so() -> None:
    assert measured(lives((-1, FOUNDER, 5))) == Threshold(0, None, None, None)
    for numbers in ((None, 0.5, 2.0), (0.5, None, 2.0), (0.5, 0.5, None)):
        assert Threshold(0, *numbers).held is None
    assert Threshold(0, 0.0, 0.5, 2.0).held == 2
    assert Threshold(0, 1.0, 0.0, 2.0).held == 0
    alive: list = [(-1, FOUNDER, 9, "alive"), (0, COPY, 5, "alive")]
    found = measured(lives(*alive))
    assert (found.as_good, found.advantage) == (None, None)


def test_stretches_of_births_are_measured_one_by_one() -> None:
    """A half of the first family's mutants are as good, all of the second's."""
    first: list = [(-1, FOUNDER, 100), *((-1, FOUNDER, 1) for _ in range(100))]
    first += [(0, COPY, 100)] * 10 + [(0, MUTANT, 100)] * 10 + [(0, MUTANT, 1)] * 10
    second = [(0, COPY, 100)] * 10 + [(0, MUTANT, 100)] * 20 + [(-1, FOUNDER, 1)] * 100
    world = lives(*first, *second)
    edges = np.array([0, len(first), len(world), len(world) + 50])
    early, late, none = over_births(3, world, edges)
    assert (early.world, early.as_good, late.as_good) == (3, 0.5, 1)
    assert early.mutated == pytest.approx(2 / 3)
    assert none == Threshold(3, None, None, None)
    whole = over_births(0, world, np.array([0, len(world)]))
    assert whole == [measured(world)]


def test_a_parent_is_good_from_the_90th_percentile_of_late_births_on() -> None:
    """Early organisms live long and do not count. Of 100 late births, 11 live 50 ticks or more."""
    early: list = [(-1, FOUNDER, 50), (-1, FOUNDER, 49), *[(-1, FOUNDER, 900)] * 98]
    late: list = [(0, COPY, 50)] * 5 + [(0, COPY, 60)] * 6 + [(0, COPY, 1)] * 9
    late += [(0, MUTANT, 1)] * 30 + [(1, COPY, 1)] * 20 + [(1, MUTANT, 1)] * 30
    found = measured(lives(*early, *late), 0.5)
    long = 5 * 50 + 6 * 60
    of_copies, of_all = (long + 9) / 20, (long + 89) / 100
    assert (found.mutated, found.as_good) == (0.6, 0)
    assert found.advantage == pytest.approx(of_copies / of_all)


def test_each_world_has_its_own_threshold() -> None:
    few: list = [(-1, FOUNDER, 5), (0, COPY, 5)]
    good: list = [(-1, FOUNDER, 100)] + [(-1, FOUNDER, 1)] * 200
    good += [(0, COPY, 100)] * 10 + [(0, MUTANT, 100)] * 5 + [(0, MUTANT, 1)] * 5
    worlds = [lives(*good), lives(*few), lives(*good, *[(0, MUTANT, 100)] * 20)]
    found: list[Any] = threshold(run_of(joined(worlds, np.arange(3))), 0.0)
    assert [each.world for each in found] == [0, 1, 2]
    assert [each.mutated for each in found] == pytest.approx([10 / 20, 0, 30 / 40])
    assert [each.as_good for each in found] == [0.5, None, 25 / 30]
    assert found[0].to_dict() == {
        "world": 0, "mutated": 0.5, "as_good": 0.5, "advantage": found[0].advantage,
        "held": pytest.approx(found[0].advantage * 0.75),
    }  # fmt: skip


def test_mutants_that_outlive_copies_count_as_equally_good() -> None:
    rows: list = [(-1, FOUNDER, 100)] + [(-1, FOUNDER, 1)] * 300
    copies: list = [(0, COPY, 100)] * 5 + [(0, COPY, 1)] * 5
    better: list = [(0, MUTANT, 100)] * 8 + [(0, MUTANT, 1)] * 2
    assert measured(lives(*rows, *copies, *better)).as_good == 1
    none: list = [(0, COPY, 1)] * 10
    assert measured(lives(*rows, *none, *better)).as_good is None


def test_organisms_alive_at_a_fork_are_parents_but_no_births() -> None:
    """Organisms that were alive at the fork had lived long. Only later births are measured."""
    rows: list = [(-1, FOUNDER, 100)] + [(0, MUTANT, 500)] * 20
    later: list = [(0, COPY, 100)] * 10 + [(0, MUTANT, 100)] * 5 + [(0, MUTANT, 1)] * 5
    later += [(-1, FOUNDER, 1)] * 100
    world = lives(*rows, *later)
    world.inherited[: len(rows)] = True
    (found,) = over_births(0, world, np.array([0, len(world)]))
    assert (found.mutated, found.as_good) == (0.5, 0.5)
    of_all = (15 * 100 + 105) / 120
    assert found.advantage == pytest.approx(100 / of_all)
    assert over_births(0, world, np.array([0, len(rows)])) == [Threshold(0, None, None, None)]


def test_a_child_that_inherits_nothing_has_no_family() -> None:
    """With `inheritance = "founder"` the record names a parent, but the child is a founder."""
    found = families(lives((-1, FOUNDER, 9), (0, FOUNDER, 5), (0, COPY, 5), (1, MUTANT, 5)), 0.0)
    assert found.born.tolist() == [0, 1, 2, 3]
    assert (found.child.tolist(), found.parent.tolist()) == ([2, 3], [0, 1])
    assert found.mutant.tolist() == [False, True]
