"""Extinctions of founders that never rose, and crashes after a rise, counted again tick by tick."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import primordia
from primordia.history import extinctions as module
from primordia.history.extinctions import Extinctions, extinctions
from primordia.law.world import Cause
from primordia.runs import loop
from primordia.runs.lives import ALIVE, Lives, joined
from tests.commands import here
from tests.synthetic import world_of
from tests.worlds import HERD, config

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
    last = ended == start
    number = np.arange(len(rows))
    world = Lives(
        world=np.zeros(len(rows), np.int32),
        id=number,
        parent=parent,
        cell=(number % CELLS).astype(np.int32),
        birth_cause=np.zeros(len(rows), np.int8),
        born=born,
        seen=born,
        inherited=np.zeros(len(born), bool),
        ended=ended,
        cause=np.where(last, ALIVE, Cause.FATAL).astype(np.int8),
    )
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


def test_crashes_of_a_run_are_those_of_its_tables(tmp_path: Path) -> None:
    """The worlds die out often, some of them after a rise."""
    settings = {**HERD, "replication": 0.3, "hazard": 0.15, "stop": {"ticks": 1500}}
    loop.start(config(settings), tmp_path / "run")
    run = primordia.load(tmp_path / "run")
    born, died = (run.table(name).to_pylist() for name in ("births", "deaths"))
    seen = Extinctions(*(np.zeros(3, np.int64) for _ in range(2)))
    for number, world in enumerate(run.info()["worlds"]):
        children = {
            row["id"] for row in born if row["world"] == number and row["parent"] is not None
        }
        changes: dict[int, int] = {}
        for rows, by in ((born, 1), (died, -1)):
            for row in rows:
                if row["world"] == number and row["id"] in children:
                    changes[row["tick"]] = changes.get(row["tick"], 0) + by
        starts = {row["tick"] for row in born if row["world"] == number} - {0}
        starts &= {row["tick"] for row in born if row["world"] == number and row["parent"] is None}
        alive = most = crashes = 0
        for tick in range(world["ticks"] + 1):
            alive += changes.get(tick, 0)
            if tick in starts:
                crashes, most = crashes + (2 * most >= HERD["cells"]), 0
            most = max(most, alive)
        assert (world["extinctions"], world["crashes"]) == (len(starts), crashes)
        seen.total[number], seen.crashes[number] = len(starts), crashes
    assert 0 < seen.crashes.sum() < seen.total.sum()
    assert "times after half of the cells were full" in here("info", run.path).stdout
