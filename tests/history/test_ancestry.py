"""Ancestors of many organisms at once, compared with a walk up each line of descent."""

from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.history import ancestry
from primordia.history.ancestry import FEW, nearest, with_ancestors
from tests.pedigrees import HISTORY, Event, line_to, walked
from tests.phylogeny.forests import ancestry as walk


@given(history=HISTORY, marks=st.sets(st.integers(0, 30), min_size=1), rows=st.integers(1, 9))
def test_the_nearest_marked_ancestor_is_that_of_a_walk(
    history: list[Event], marks: set[int], rows: int
) -> None:
    """The records are read in parts. The last part may be a single organism."""
    lives = walked(history)
    marked = sorted({each % len(lives) for each in marks})
    expected = [
        next((each for each in line_to(lives, row) if each in marked), -1)
        for row in range(len(lives))
    ]
    with patch.object(ancestry, "ROWS", rows):
        assert nearest(lives.parent_row, np.array(marked)).tolist() == expected


@pytest.mark.parametrize("count", [1, FEW, FEW + 1])
def test_ancestors_are_those_of_a_walk_through_one_or_both_parents(count: int) -> None:
    """A few lines are followed one by one, and many lines together."""
    draw = np.random.default_rng(count)
    older = np.arange(60)
    first, second = np.where(older < 3, -1, draw.integers(-1, np.maximum(older, 1), (2, 60)))
    rows = draw.choice(np.arange(20, 60), count, replace=False)
    for parents in ((first, second), (first,)):
        known = {row: [int(each[row]) for each in parents if each[row] >= 0] for row in range(60)}
        expected = sorted(walk(known, set(rows.tolist())))
        assert with_ancestors(rows, *parents).tolist() == expected
