"""Extinctions of founders that never rose, and crashes after a rise, counted again tick by tick."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.history import extinctions as module
from primordia.history.extinctions import extinctions
from primordia.runs.lives import Lives, joined
from tests.synthetic import one_world, world_of

CELLS = 8
COHORT = st.tuples(
    st.integers(1, CELLS),
    st.integers(2, 12),
    st.lists(st.tuples(st.integers(0, 20), st.integers(1, 20)), max_size=12),
)
"""Founders, ticks until the last has died, and children: birth and lifespan, both cut to these ticks."""


def lived(cohorts: list) -> tuple[Lives, list[bool]]:
    """Return a world of founding cohorts, the last still alive, and whether each but the last rose."""
    rows, rose, start = [], [], 0
    for founders, ticks, children in cohorts:
        born = [(min(1 + at, ticks - 1), at + span) for at, span in children]
        spans = [(start + at, start + min(at + span, ticks)) for at, span in born]
        rows += [(start, start + ticks, -1)] * founders
        rows += [(*span, 0) for span in sorted(spans)]
        most = max(
            sum(begin <= tick < end for begin, end in spans) for tick in range(start, start + ticks)
        )
        rose.append(2 * most >= CELLS)
        start += ticks
    born, ended, parent = (np.array(column) for column in zip(*rows, strict=True))
    cell = (np.arange(len(rows)) % CELLS).astype(np.int32)
    world = one_world(born, ended, ended != start, parent, cell=cell)
    return world, rose[:-1]


@given(st.lists(COHORT, min_size=1, max_size=6))
def test_a_crash_is_an_extinction_after_half_of_the_cells_were_full(cohorts: list) -> None:
    """Founders do not count, even if they fill the world."""
    world, rose = lived(cohorts)
    found = extinctions([world, world], CELLS)
    assert found.total.tolist() == [len(cohorts) - 1] * 2
    assert found.crashes.tolist() == [sum(rose)] * 2


@given(st.lists(COHORT, min_size=2, max_size=6), st.data())
def test_a_record_that_begins_later_holds_the_extinctions_since(
    cohorts: list, data: st.DataObject
) -> None:
    world, _ = lived(cohorts)
    starts = np.cumsum([0, *(ticks for _, ticks, _ in cohorts)])[1:-1]
    begin = data.draw(st.integers(0, int(world.ended.max()) - 1))
    later = extinctions([world.recorded_since(begin)], CELLS)
    assert later.total.tolist() == [(starts > begin).sum()]
    assert later.crashes[0] <= extinctions([world], CELLS).crashes[0]


def test_a_fork_whose_founders_are_dead_counts_the_extinction_of_their_children() -> None:
    world = world_of([(0, 3, True), (1, 18, True), (20, 9, False)], until=60)
    world.parent[1] = 0
    assert extinctions([world.recorded_since(10), world], CELLS).total.tolist() == [1, 1]


def words(counts: list[int]) -> dict[str, np.ndarray]:
    """Return counts as the arrays of a state."""
    low = np.array(counts, np.uint32)
    return {f"{module.NAME}.hi": np.zeros_like(low), f"{module.NAME}.lo": low}


def worlds_with(before: list[int] | None, counts: list[int], lives: Lives | None) -> Any:
    """Return a stand-in for a run, or for a fork of worlds with `before` extinctions."""

    class Run:
        config = SimpleNamespace(cells=CELLS)
        origin = None if before is None else words(before)

        def count(self, name: str) -> np.ndarray:
            assert name == module.NAME
            return np.array(counts, np.uint32)

        @property
        def lives(self) -> Lives:
            if lives is None:
                pytest.fail("lives are read")
            return lives

    return Run()


def test_crashes_are_those_of_their_own_worlds() -> None:
    """Some worlds between the others did not die out, or not since the fork."""
    risen, flat = (lived([(1, 9, [(1, 5)] * n), (1, 9, [])] * 2)[0] for n in (4, 3))
    calm, _ = lived([(3, 9, [])])
    lives = joined([calm, risen, flat, calm, risen], np.arange(5))
    new = module.extinctions_of(worlds_with(None, [0, 3, 3, 0, 3], lives))
    fork = module.extinctions_of(worlds_with([5, 6, 0, 7, 8], [5, 9, 3, 7, 11], lives))
    for found in (new, fork):
        assert found.total.tolist() == [0, 3, 3, 0, 3]
        assert found.crashes.tolist() == [0, 2, 0, 0, 2]
    assert module.extinctions_of(worlds_with([5, 6], [5, 6], None)).crashes.tolist() == [0, 0]
