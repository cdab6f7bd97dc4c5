"""Placement, compared with a plain reference that acts one by one, and with expected frequencies."""

import math
from collections.abc import Callable
from functools import cache
from itertools import product

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from primordia.law.placement import Placement
from primordia.random.wide import Wide
from tests.chance import even
from tests.chronicle import reach

TOPOLOGIES = ["ring", "torus4", "torus8", "well-mixed"]
RULES = ["blind", "empty-only", "replacing"]
ALL = list(product(TOPOLOGIES, RULES))
W, N = 2, 12  # a torus of 3 x 4


@cache
def compiled(topology: str, rule: str) -> Callable:
    """Return the function from words (rounds, 2, W, N), wants and occupied (W, N) to parents (W, N)."""
    placement = Placement(topology=topology, rule=rule)

    def place(words: jax.Array, wants: jax.Array, occupied: jax.Array) -> jax.Array:
        return placement.parents(lambda number: Wide(*words[number]), wants, occupied)

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


def a_tick(seed: int, density: float, eager: float, coarse: bool) -> tuple[np.ndarray, ...]:
    """Return words, wants and occupied; with `coarse`, priorities are often equal."""
    rng = np.random.default_rng(seed)
    words = rng.integers(0, 2**32, (N + 1, 2, W, N), dtype=np.uint32)
    if coarse:
        words[:, 1] &= 1
    occupied = rng.random((W, N)) < density
    return words, occupied & (rng.random((W, N)) < eager), occupied


ticks = st.builds(
    a_tick, st.integers(0, 2**32), st.floats(0, 1), st.sampled_from([0.3, 1.0]), st.booleans()
)


@pytest.mark.parametrize(("topology", "rule"), ALL)
@settings(max_examples=60)
@given(ticks)
def test_placing_all_at_once_equals_placing_one_by_one(
    topology: str, rule: str, tick: tuple[np.ndarray, ...]
) -> None:
    words, wants, occupied = tick
    parents = compiled(topology, rule)(*tick)
    assert parents.dtype == jnp.int32
    for world in range(W):
        alone = one_after_another(topology, rule, words[:, :, world], wants[world], occupied[world])
        assert parents[world].tolist() == alone.tolist()


@pytest.mark.parametrize(("topology", "rule"), ALL)
@settings(max_examples=60)
@given(ticks)
def test_births_obey_the_rules_of_placement(
    topology: str, rule: str, tick: tuple[np.ndarray, ...]
) -> None:
    words, wants, occupied = tick
    parents = np.asarray(compiled(topology, rule)(*tick))
    for parent, want, full in zip(parents, wants, occupied, strict=True):
        born = np.flatnonzero(parent >= 0)
        satisfied = parent[born].tolist()
        assert len(set(satisfied)) == len(satisfied), "two children in one tick"
        assert want[satisfied].all()
        for child, cell in zip(born, satisfied, strict=True):
            assert child in reach(topology, cell, N)
            assert child != cell
        if rule != "replacing":
            assert not full[born].any()
        if rule == "empty-only":
            after = full | (parent >= 0)
            for cell in set(np.flatnonzero(want)) - set(satisfied):
                assert after[reach(topology, cell, N)].all(), "it had an empty cell in reach"
    if rule != "empty-only":
        choice = words[0, 0].astype(object)
        for world, cell in zip(*np.nonzero(wants), strict=True):
            options = reach(topology, int(cell), N)
            picked = options[choice[world, cell] * len(options) >> 32]
            if rule == "replacing" or not occupied[world, picked]:
                assert parents[world, picked] >= 0, "no birth in a cell that a parent chose"


@pytest.mark.parametrize(("topology", "rule"), ALL)
@settings(max_examples=25)
@given(ticks)
def test_room_is_a_cell_in_reach_that_would_take_a_child(
    topology: str, rule: str, tick: tuple[np.ndarray, ...]
) -> None:
    _, _, occupied = tick
    room = Placement(topology=topology, rule=rule).room(jnp.asarray(occupied))
    assert room.shape == (W, N)
    for world, cell in zip(*np.nonzero(occupied), strict=True):
        free = [option for option in reach(topology, int(cell), N) if not occupied[world, option]]
        assert bool(room[world, cell]) == (rule == "replacing" or bool(free))


@pytest.mark.parametrize(("topology", "rule"), ALL)
def test_without_parents_there_are_no_births(topology: str, rule: str) -> None:
    words, _, occupied = a_tick(1, 0.5, 1.0, coarse=False)
    assert (compiled(topology, rule)(words, np.zeros((W, N), bool), occupied) == -1).all()


def many(rule: str, topology: str, occupied: list[bool]) -> tuple[np.ndarray, np.ndarray]:
    """Return parents (worlds, cells) of many equal worlds in which all organisms want a child.

    Also return the cell that each organism would take if it could choose freely.
    """
    worlds, cells = 30_000, len(occupied)
    words = np.random.default_rng(7).integers(0, 2**32, (6, 2, worlds, cells), dtype=np.uint32)
    full = np.tile(np.array(occupied), (worlds, 1))
    parents = np.asarray(compiled(topology, rule)(words, full, full))
    options = np.array([reach(topology, cell, cells) for cell in range(cells)])
    nth = (words[0, 0].astype(np.uint64) * np.uint64(options.shape[1])) >> np.uint64(32)
    return parents, options[np.arange(cells), nth.astype(int)]


@pytest.mark.parametrize("rule", RULES)
def test_two_contenders_win_equally_often(rule: str) -> None:
    parents, picked = many(rule, "ring", [True, False, True, True])
    contested = (picked[:, [0, 2]] == 1).all(axis=1) | (rule == "empty-only")
    winners = np.bincount(parents[contested, 1], minlength=4)
    assert winners[[1, 3]].sum() == 0
    assert even(winners[[0, 2]])


@pytest.mark.parametrize("rule", RULES)
def test_three_contenders_win_equally_often(rule: str) -> None:
    parents, picked = many(rule, "well-mixed", [True, True, True, False])
    contested = (picked[:, :3] == 3).all(axis=1) | (rule == "empty-only")
    winners = np.bincount(parents[contested, 3], minlength=4)
    assert winners[3] == 0
    assert even(winners[:3])


def test_a_loser_tries_its_other_empty_neighbour() -> None:
    """Cells 1 and 3 are empty, and 0 and 2 reach both, so both organisms get a child."""
    parents, _ = many("empty-only", "ring", [True, False, True, False])
    assert (np.sort(parents[:, [1, 3]], axis=1) == [0, 2]).all()
    assert even(np.bincount(parents[:, 1], minlength=3)[[0, 2]])


@pytest.mark.parametrize(("topology", "rule"), ALL)
def test_every_direction_is_equally_likely(topology: str, rule: str) -> None:
    """Each of many worlds has one organism, with one of its neighbours occupied."""
    worlds, home, other = 24_000, 5, 4
    words = np.random.default_rng(3).integers(0, 2**32, (2, 2, worlds, N), dtype=np.uint32)
    wants = np.zeros((worlds, N), bool)
    wants[:, home] = True
    occupied = wants.copy()
    occupied[:, other] = True
    parents = np.asarray(compiled(topology, rule)(words, wants, occupied))
    births = np.bincount(np.nonzero(parents >= 0)[1], minlength=N)
    options = reach(topology, home, N)
    assert len(set(options)) == len(options)
    open_ = [cell for cell in options if rule == "replacing" or cell != other]
    assert births.sum() == births[open_].sum()
    if len(open_) > 1:
        assert even(births[open_])
    share = 1 - 1 / len(options) if rule == "blind" else 1
    spread = math.sqrt(worlds * share * (1 - share))
    assert abs(births.sum() - worlds * share) <= 5 * spread


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
    room = Placement(topology="torus4", rows=rows).room(jnp.asarray(only_cell_0_is_empty))
    assert np.flatnonzero(room[0]).tolist() == around
