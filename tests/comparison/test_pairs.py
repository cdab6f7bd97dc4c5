"""Worlds of the same seeds: pairs by their order, and intervals that draw pairs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.comparison.contrast import contrast
from primordia.comparison.measured import Measured
from primordia.comparison.pairs import paired, same_seeds
from primordia.comparison.resample import LEAST

VALUE = st.tuples(st.integers(1, 20), st.booleans())
PAIRS = st.lists(st.tuples(VALUE, VALUE), min_size=1, max_size=12)
ENOUGH = st.lists(st.tuples(VALUE, VALUE), min_size=LEAST, max_size=12)


def both(pairs: list) -> tuple[Measured, Measured]:
    """Return the values of both runs."""
    one, other = (
        Measured(*(np.array(column) for column in zip(*worlds, strict=True)))
        for worlds in zip(*pairs, strict=True)
    )
    return one, other


def in_order(pairs: list) -> tuple[np.ndarray, np.ndarray]:
    return np.arange(len(pairs)), np.arange(len(pairs))


@given(PAIRS)
def test_pairs_count_where_their_order_is_known(pairs: list) -> None:
    run, reference = both(pairs)
    within = paired(run, reference)
    assert contrast(run, reference, in_order(pairs)).paired == within
    larger = sum(value > other and known for (value, _), (other, known) in pairs)
    smaller = sum(value < other and known for (value, known), (other, _) in pairs)
    assert tuple(within) == (len(pairs), larger, smaller)
    assert within.delta == pytest.approx((larger - smaller) / len(pairs))


@given(ENOUGH, st.data())
def test_the_order_of_worlds_in_a_run_does_not_matter(pairs: list, data: st.DataObject) -> None:
    """Worlds are matched by their seeds."""
    run, reference = both(pairs)
    seeds = np.arange(100, 100 + len(pairs), dtype=np.uint64)
    orders = [np.array(data.draw(st.permutations(range(len(pairs))))) for _ in range(2)]
    rows = same_seeds(*(seeds[order] for order in orders))
    shuffled = contrast(run.take(orders[0]), reference.take(orders[1]), rows)
    assert shuffled == contrast(run, reference, same_seeds(seeds, seeds))


@pytest.mark.parametrize(
    ("one", "other"),
    [([0, 1], [0, 2]), ([0, 1, 2], [0, 1]), ([0, 0, 1], [0, 0, 1]), ([0, 1], [2, 3])],
)
def test_runs_without_the_same_seeds_have_no_pairs(one: list[int], other: list[int]) -> None:
    assert same_seeds(np.array(one), np.array(other)) is None


def test_worlds_without_pairs_are_independent() -> None:
    values = Measured(np.arange(1.0, 41), np.ones(40, bool))
    assert contrast(values, values).paired is None
    low, high = contrast(values, values).interval or (0, 0)
    assert low < 0.8 < 1.2 < high
    assert contrast(values, values, (np.arange(40), np.arange(40))).interval == (1, 1)
