"""Recombination: units come whole from either parent; mates are living neighbours of the child."""

from typing import Any

import jax
import numpy as np
import pytest

from primordia.brains.layout import Layout
from primordia.compiled import shared
from primordia.law.placement import Placement
from primordia.law.recombination import Recombination
from primordia.random.wide import Wide
from primordia.settings.islands import Islands


def test_a_mate_is_chosen_by_the_high_word_and_refused_by_the_low_one() -> None:
    """The high word picks one of the candidates. A low word below the probability brings a mate."""
    random = np.random.default_rng(6)
    candidates = random.random((200, 7)) < 0.5
    high, low = random.integers(0, 2**32, (2, 200), np.uint32)
    low[:4] = 2**31 - 1, 2**31, 0, 2**32 - 1
    candidates[:4] = True
    mates_of = shared(Recombination.mates, Recombination(probability=0.5))
    found = np.asarray(mates_of(Wide(high, low), candidates))
    for row, mate in enumerate(found.tolist()):
        cells = np.flatnonzero(candidates[row]).tolist()
        wanted = cells and int(low[row]) < 2**31
        assert mate == (cells[int(high[row]) * len(cells) >> 32] if wanted else -1)


def test_rows_of_blocks_of_equal_height_share_units_and_other_rows_have_their_own() -> None:
    layout = Layout((("a", (3, 2)), ("b", (1, 5)), ("c", (2, 2, 2)), ("d", (3,)), ("e", (4, 1))))
    rows = [0, 0, 1, 1, 2, 2, *[3] * 5, *[4] * 4, *[5] * 4, 0, 1, 2, 6, 7, 8, 9]
    assert Recombination(unit="row").units(layout).tolist() == rows
    blocks = [0] * 6 + [1] * 5 + [2] * 8 + [3] * 3 + [4] * 4
    assert Recombination(unit="block").units(layout).tolist() == blocks


@pytest.mark.parametrize(
    ("topology", "near"),
    [("ring", [{1, 8}, {0, 7}]), ("torus4", [{1, 2, 3, 6}, {2, 5, 6, 7}]),
     ("well-mixed", [{1, 2, 3}, {4, 5, 6, 7}])],
)  # fmt: skip
def test_neighbours_are_those_of_the_topology(topology: Any, near: list[set[int]]) -> None:
    """In well-mixed worlds mates are of the same island; on a ring or torus they live next door."""
    near_of = jax.jit(Placement(topology=topology).near, static_argnums=1)
    found = np.asarray(near_of(np.int32([0, 8]), Islands(("west", "east"), (0, 4, 9))))
    assert [set(np.flatnonzero(each).tolist()) for each in found] == near
