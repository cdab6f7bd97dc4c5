"""Inheritance of lifespan: slopes that are known, and the Price equation, which is an identity."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.history.families import LEAST, families, families_of
from primordia.history.heredity import heredity, price, slope
from primordia.runs.lives import Lives, joined
from tests.assays.lives import COPY, FOUNDER, MUTANT, lives


def measured(world: Lives, after: float = 0.0) -> Any:
    return heredity(SimpleNamespace(lives=world), after)[0]


def test_copies_inherit_all_and_mutants_what_is_left() -> None:
    """Copies live as long as their parents; mutants the square root of it, half on the log scale."""
    parents = [(-1, FOUNDER, 4**n) for n in range(1, 6)] * 3
    copies = [(n, COPY, 4 ** (n % 5 + 1)) for n in range(15)]
    mutants = [(n, MUTANT, 2 ** (n % 5 + 1)) for n in range(15)]
    found = measured(lives(*parents, *copies, *mutants))
    assert found.copies.slope == pytest.approx(1)
    assert found.mutants.slope == pytest.approx(0.5)
    assert found.both.slope == pytest.approx(0.75)
    assert (found.copies.as_long, found.copies.longer, found.copies.shorter) == (1, 0, 0)
    assert (found.mutants.as_long, found.mutants.longer, found.mutants.shorter) == (0, 0, 1)
    assert (found.copies.pairs, found.mutants.pairs, found.both.pairs) == (15, 15, 30)


def test_pairs_with_a_living_organism_have_no_slope_yet() -> None:
    rows: list = [
        (-1, FOUNDER, 100),
        (0, COPY, 50, "alive"),
        (-1, FOUNDER, 100, "alive"),
        (2, COPY, 9),
        (0, MUTANT, 50, "alive"),
        (2, MUTANT, 9),
    ]
    found = measured(lives(*rows))
    for pairs in (found.copies, found.mutants, found.both):
        assert (pairs.pairs, pairs.slope) == (0, None)
    assert found.selection is None


def test_only_late_children_count() -> None:
    rows = [(-1, FOUNDER, 10), *((0, COPY, 10) for _ in range(9))]
    assert measured(lives(*rows), 0.5).both.pairs == 5
    assert measured(lives(*rows), 0.0).both.pairs == 9


def test_a_slope_needs_points_of_different_x() -> None:
    x = np.linspace(0, 1, LEAST)
    assert slope(x, 3 * x + 1) == pytest.approx(3)
    assert slope(x[1:], x[1:]) is None
    assert slope(np.ones(LEAST), x) is None


@st.composite
def pedigrees(draw: st.DrawFn) -> Lives:
    rows: list = []
    for number in range(draw(st.integers(2, 25))):
        parent = draw(st.integers(-1, number - 1))
        cause = FOUNDER if parent < 0 else draw(st.sampled_from([COPY, MUTANT]))
        row = (parent, cause, draw(st.integers(1, 50)))
        rows.append((*row, "alive") if draw(st.integers(0, 9)) == 0 else row)
    return lives(*rows)


@given(pedigrees(), st.sampled_from([0.0, 0.5]))
def test_selection_and_transmission_add_up_to_the_change(world: Lives, after: float) -> None:
    found = families(world, after)
    selection, transmission = price(found)
    late = set(np.flatnonzero(world.late(after)).tolist()) | set(found.parent.tolist())
    spoilt = set(found.parent[~world.died[found.child]].tolist())
    counted = [row for row in late if world.died[row] and row not in spoilt]
    children = [int(c) for c, p in zip(found.child, found.parent, strict=True) if p in counted]
    if not children:
        assert selection is None
        assert transmission is None
        return
    assert selection is not None
    assert transmission is not None
    z = np.log(world.lifespan)
    change = z[children].mean() - z[counted].mean()
    assert selection + transmission == pytest.approx(change, abs=1e-9)


def test_each_world_has_its_own_measures() -> None:
    """Children of the first world live as long as their parent; of the second, longer or shorter."""
    first = lives((-1, FOUNDER, 30), *[(0, COPY, 30)] * 12)
    second = lives((-1, FOUNDER, 30), (0, COPY, 33), (0, MUTANT, 20), (0, MUTANT, 21))
    both = joined([first, second], np.arange(2))
    one, other = heredity(SimpleNamespace(lives=both), 0.0)
    assert (one.world, other.world) == (0, 1)
    assert (one.copies.pairs, one.copies.as_long) == (12, 1)
    assert one.mutants.pairs == 0
    found = [(each.longer, each.as_long, each.shorter) for each in (other.copies, other.mutants)]
    assert found == [(1, 0, 0), (0, 0, 0.5)]
    assert (other.both.pairs, other.both.longer) == (3, pytest.approx(1 / 3))
    plain = other.to_dict()
    assert (plain["world"], plain["copies"]["pairs"], plain["mutants"]["shorter"]) == (1, 1, 0.5)
    assert (plain["selection"], plain["transmission"]) == (other.selection, other.transmission)


def test_the_price_equation_by_hand() -> None:
    """Three founders have two children, one child and none. Logarithms of lifespans are natural."""
    rows = [(-1, FOUNDER, 1), (-1, FOUNDER, 10), (-1, FOUNDER, 100), (2, COPY, 5000)]
    selection, transmission = price(
        families_of(lives(*rows, (2, MUTANT, 10), (1, COPY, 10)), np.array([3, 4, 5]))
    )
    counted = np.log([10.0, 100, 5000, 10, 10])  # the parents 1 and 2, and the children
    w = np.array([1, 2, 0, 0, 0])
    assert selection == pytest.approx(np.mean((w - w.mean()) * counted) / w.mean())
    change = [np.log(10 / 10), np.log(5000 / 100) + np.log(10 / 100)]
    assert transmission == pytest.approx(sum(change) / 5 / w.mean())


def test_a_life_of_no_tick_counts_as_one_tick() -> None:
    rows = [(-1, FOUNDER, 0), (-1, FOUNDER, 4)]
    children = [*[(0, COPY, 1)] * 5, *[(1, COPY, 16)] * 5]
    assert measured(lives(*rows, *children)).both.slope == pytest.approx(2)
