"""Placement, compared with a plain reference that acts one by one, and with expected frequencies."""

import math
from collections.abc import Callable
from functools import cache
from itertools import product

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.law.placement import Placement
from primordia.random.wide import Wide
from tests.chance import even
from tests.chronicle import reach

TOPOLOGIES = ["ring", "torus4", "torus8", "well-mixed"]
RULES = ["blind", "empty-only", "replacing"]
QUICK = [
    *product(["ring"], RULES),
    ("torus8", "blind"),
    ("well-mixed", "empty-only"),
    ("well-mixed", "replacing"),
]
"""Each topology and each rule. Only well-mixed worlds look for a cell in another way with each rule."""
each_kind = pytest.mark.parametrize(
    ("topology", "rule"),
    [
        pytest.param(*pair, marks=() if pair in QUICK else pytest.mark.slow)
        for pair in product(TOPOLOGIES, RULES)
    ],
)
W, N = 12_000, 12  # a torus of 3 x 4
ROUNDS = N + 1


@cache
def compiled(topology: str, rule: str) -> Callable:
    """Return the function from words (rounds, 2, W, N), wants and occupied (W, N) to parents and room."""
    placement = Placement(topology=topology, rule=rule)

    def place(words: jax.Array, wants: jax.Array, occupied: jax.Array) -> tuple:
        parents = placement.parents(lambda number: Wide(*words[number]), wants, occupied)
        return parents, placement.room(occupied)

    return jax.jit(place)


def one_after_another(
    topology: str, rule: str, words: np.ndarray, wants: np.ndarray, occupied: np.ndarray
) -> np.ndarray:
    """Return parents (N,) in one world from words (rounds, 2, N), wants (N,) and occupied (N,)."""
    cells = len(wants)
    parent, full = np.full(cells, -1), occupied.copy()
    waiting = list(np.flatnonzero(wants))
    for choice, priority in words:
        in_order = sorted(waiting, key=lambda cell: (priority[cell], cell))
        before, waiting = full.copy(), []
        for cell in in_order:
            options = reach(topology, cell, cells)
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


@cache
def words(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 2**32, (ROUNDS, 2, W, N), dtype=np.uint32)


@each_kind
def test_placing_all_at_once_equals_placing_one_by_one(topology: str, rule: str) -> None:
    """Each world is filled to a random share. In every second world many priorities are equal. In world 5
    no organism wants a child.

    There is room beside an organism if a cell in its reach would take a child.
    """
    rng, drawn = np.random.default_rng(2), words(1).copy()
    drawn[:, 1, ::2] &= 1
    occupied = rng.random((W, N)) < rng.random((W, 1))
    wants = occupied & (rng.random((W, N)) < rng.choice([0.3, 1.0], (W, 1)))
    wants[5] = False
    parents, room = map(np.asarray, compiled(topology, rule)(drawn, wants, occupied))
    assert parents.dtype == np.int32
    for world in range(200):
        alone = one_after_another(topology, rule, drawn[:, :, world], wants[world], occupied[world])
        assert parents[world].tolist() == alone.tolist()
        for cell in np.flatnonzero(occupied[world]):
            free = not occupied[world, reach(topology, int(cell), N)].all()
            assert room[world, cell] == (rule == "replacing" or free)


def many(rule: str, topology: str, empty: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """Return parents (W, N) of many equal worlds in which all organisms want a child.

    Also return the cell that each organism would take if it could choose freely.
    """
    full = np.tile(~np.isin(np.arange(N), empty), (W, 1))
    parents = np.asarray(compiled(topology, rule)(words(7), full, full)[0])
    options = np.array([reach(topology, cell, N) for cell in range(N)])
    nth = (words(7)[0, 0].astype(np.uint64) * np.uint64(options.shape[1])) >> np.uint64(32)
    return parents, options[np.arange(N), nth.astype(int)]


@pytest.mark.parametrize("rule", RULES)
def test_two_contenders_win_equally_often(rule: str) -> None:
    parents, picked = many(rule, "ring", [1])
    contested = (picked[:, [0, 2]] == 1).all(axis=1) | (rule == "empty-only")
    winners = np.bincount(parents[contested, 1], minlength=N)
    assert winners.sum() == winners[[0, 2]].sum() > 2000
    assert even(winners[[0, 2]])


def test_many_contenders_win_equally_often() -> None:
    parents, _ = many("empty-only", "well-mixed", [3])
    winners = np.bincount(parents[:, 3], minlength=N)
    assert winners[3] == 0
    assert even(np.delete(winners, 3))


@each_kind
def test_every_direction_is_equally_likely(topology: str, rule: str) -> None:
    """Each of many worlds has one organism, with one of its neighbours occupied."""
    home, other = 5, 4
    wants = np.zeros((W, N), bool)
    wants[:, home] = True
    occupied = wants.copy()
    occupied[:, other] = True
    parents = np.asarray(compiled(topology, rule)(words(3), wants, occupied)[0])
    births = np.bincount(np.nonzero(parents >= 0)[1], minlength=N)
    options = reach(topology, home, N)
    assert len(set(options)) == len(options)
    open_ = [cell for cell in options if rule == "replacing" or cell != other]
    assert births.sum() == births[open_].sum()
    if len(open_) > 1:
        assert even(births[open_])
    share = 1 - 1 / len(options) if rule == "blind" else 1
    spread = math.sqrt(W * share * (1 - share))
    assert abs(births.sum() - W * share) <= 5 * spread


@pytest.mark.parametrize(
    ("cells", "rows", "shape"),
    [
        (4, None, (2, 2)),
        (12, None, (3, 4)),
        (16, None, (4, 4)),
        (32, None, (4, 8)),
        (36, None, (6, 6)),
        (26, None, (2, 13)),
        (1024, None, (32, 32)),
        (12, 2, (2, 6)),
        (12, 6, (6, 2)),
        (12, 4, (4, 3)),
    ],
)
@pytest.mark.parametrize("topology", ["torus4", "torus8"])
def test_a_torus_has_its_rows_or_is_nearly_square(
    topology: str, cells: int, rows: int | None, shape: tuple[int, int]
) -> None:
    assert Placement(topology=topology, rows=rows).shape(cells) == shape


@given(st.integers(4, 5000))
def test_a_torus_is_as_nearly_square_as_its_cells_allow(cells: int) -> None:
    pairs = [(r, cells // r) for r in range(2, cells // 2 + 1) if cells % r == 0]
    if pairs:
        best = min(pairs, key=lambda pair: (abs(pair[0] - pair[1]), pair[0]))
        assert Placement(topology="torus4").shape(cells) == best
    else:
        with pytest.raises(ValueError, match=f"{cells} cells do not make a torus"):
            Placement(topology="torus4").shape(cells)


@pytest.mark.parametrize(("cells", "rows"), [(13, None), (2, None), (3, None), (12, 5), (12, 12)])
def test_impossible_tori_are_refused(cells: int, rows: int | None) -> None:
    with pytest.raises(ValueError, match="do not make a torus"):
        Placement(topology="torus8", rows=rows).shape(cells)


@pytest.mark.parametrize(("rows", "around"), [(6, [1, 2, 10]), (2, [1, 5, 6]), (3, [1, 3, 4, 8])])
def test_rows_decide_which_cells_are_neighbours(rows: int, around: list[int]) -> None:
    only_cell_0_is_empty = np.arange(12)[None] > 0
    room = jax.jit(Placement(topology="torus4", rows=rows).room)(only_cell_0_is_empty)
    assert np.flatnonzero(room[0]).tolist() == around
