"""Placement, compared with a plain reference that acts one by one."""

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.law.placement import Placement
from primordia.random.wide import Wide
from tests.chronicle import reach

W, N = 200, 12  # a torus of 3 x 4
ROUNDS = N + 1


def one_after_another(
    near: Callable[[int], list[int]],
    rule: str,
    words: np.ndarray,
    wants: np.ndarray,
    occupied: np.ndarray,
) -> np.ndarray:
    """Return parents (N,) in one world from words (rounds, 2, N), wants (N,) and occupied (N,).

    `near` gives the cells in which a child of a cell may be born.
    """
    parent, full = np.full(len(wants), -1), occupied.copy()
    waiting = list(np.flatnonzero(wants))
    for choice, priority in words:
        in_order = sorted(waiting, key=lambda cell: (priority[cell], cell))
        before, waiting = full.copy(), []
        for cell in in_order:
            options = near(cell)
            if rule == "empty-only":
                options = [option for option in options if not before[option]]
            if not options:
                continue
            target = options[int(choice[cell]) * len(options) >> 32]
            taken = parent[target] >= 0 if rule == "replacing" else full[target]
            if not taken:
                parent[target], full[target] = cell, True
            elif rule == "empty-only":
                waiting.append(cell)
        if not waiting:
            break
    return parent


def words(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 2**32, (ROUNDS, 2, W, N), dtype=np.uint32)


@pytest.mark.parametrize(
    ("topology", "rule"),
    [
        ("ring", "blind"),
        ("torus4", "replacing"),
        ("torus8", "empty-only"),
        ("well-mixed", "replacing"),
    ],
)
def test_placing_all_at_once_equals_placing_one_by_one(topology: Any, rule: Any) -> None:
    """Each world is filled to a random share. In every second world many priorities are equal. In world 5
    no organism wants a child.

    There is room beside an organism if a cell in its reach would take a child. Each topology and each
    rule is tried; `test_turnover.py` looks for empty cells of well-mixed worlds.
    """
    placement = Placement(topology=topology, rule=rule)

    def place(words: jax.Array, wants: jax.Array, occupied: jax.Array) -> tuple:
        parents = placement.parents(lambda number: Wide(*words[number]), wants, occupied)
        return parents, placement.room(occupied)

    rng, drawn = np.random.default_rng(2), words(1)
    drawn[:, 1, ::2] &= 1
    occupied = rng.random((W, N)) < rng.random((W, 1))
    wants = occupied & (rng.random((W, N)) < rng.choice([0.3, 1.0], (W, 1)))
    wants[5] = False
    parents, room = map(np.asarray, jax.jit(place)(drawn, wants, occupied))
    assert parents.dtype == np.int32
    for world in range(W):
        near = partial(reach, topology, cells=N)
        alone = one_after_another(near, rule, drawn[:, :, world], wants[world], occupied[world])
        assert parents[world].tolist() == alone.tolist()
        for cell in np.flatnonzero(occupied[world]):
            free = not occupied[world, reach(topology, int(cell), N)].all()
            assert room[world, cell] == (rule == "replacing" or free)


@given(st.integers(4, 5000))
def test_a_torus_is_as_nearly_square_as_its_cells_allow(cells: int) -> None:
    pairs = [(r, cells // r) for r in range(2, cells // 2 + 1) if cells % r == 0]
    if pairs:
        best = min(pairs, key=lambda pair: (abs(pair[0] - pair[1]), pair[0]))
        assert Placement(topology="torus4").shape(cells) == best
    else:
        with pytest.raises(ValueError, match=f"{cells} cells do not make a torus"):
            Placement(topology="torus4").shape(cells)


@pytest.mark.parametrize(("cells", "rows"), [(13, None), (3, None), (12, 5), (12, 12)])
def test_impossible_tori_are_refused(cells: int, rows: int | None) -> None:
    with pytest.raises(ValueError, match="do not make a torus"):
        Placement(topology="torus8", rows=rows).shape(cells)


@pytest.mark.parametrize(("rows", "around"), [(6, [1, 2, 10]), (2, [1, 5, 6])])
def test_rows_decide_which_cells_are_neighbours(rows: int, around: list[int]) -> None:
    assert Placement(topology="torus4", rows=rows).shape(12) == (rows, 12 // rows)
    only_cell_0_is_empty = np.arange(12)[None] > 0
    room = jax.jit(Placement(topology="torus4", rows=rows).room)(only_cell_0_is_empty)
    assert np.flatnonzero(room[0]).tolist() == around
