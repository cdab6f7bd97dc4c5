"""Worlds in which organisms choose when to copy themselves keep the promises."""

from pathlib import Path

import numpy as np
import pytest

import primordia
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.archive import Archive
from tests.engine.test_strange import digests, live_in_parts
from tests.history.test_rebuilding import assert_rebuilt
from tests.organism.test_life import assert_ends_as_recorded
from tests.strange import GIVING, TICKS
from tests.worlds import Lived, config


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("giving") / "run"
    live_in_parts(GIVING, path)
    return path


def test_parts_and_chunks_of_any_length_make_the_same_run(run: Path) -> None:
    assert digests(run) == Lived(config(GIVING), TICKS, chunk=11).digests()
    assert primordia.load(run).verify() == []
    assert_rebuilt(run)


def test_parents_live_again_with_the_same_energy(run: Path) -> None:
    """Also those that were replaced in the tick of their last child, and the living."""
    opened = Archive(run)
    lives = opened.lives
    children = np.bincount(lives.parent_row[lives.parent_row >= 0], minlength=len(lives))
    last = np.zeros(len(lives), np.int64)
    np.maximum.at(last, lives.parent_row[lives.parent_row >= 0], lives.born[lives.parent_row >= 0])
    at_once = (lives.cause == Cause.REPLACED) & (last == lives.ended)
    chosen = [children > 2, at_once, ~lives.died & (children > 0), lives.cause == Cause.HAZARD]
    for rows in map(np.flatnonzero, chosen):
        assert len(rows)
        for row in rows[-5:]:
            life = RelivedLife.of(opened, int(lives.id[row]), int(lives.world[row]))
            seen = assert_ends_as_recorded(life)
            if life.cause is not None:
                assert seen[-1].energy[-1] == life.at_death[0]


def test_a_fork_keeps_endowments_and_counts_on(run: Path, tmp_path: Path) -> None:
    before, at = Archive(run), 150
    fork = Archive(primordia.load(run).fork(at, tmp_path / "fork", stop={"ticks": TICKS}).path)
    older = fork.lives.take(np.flatnonzero(fork.lives.inherited))
    assert len(older) > 10
    rows = before.lives.rows_of(older.world, older.id)
    then = before.endowments_of(before.lives.take(rows))
    np.testing.assert_array_equal(fork.endowments_of(older), then)
    assert len(set((then / ONE).tolist())) > 5
    names = [name for name in before.state if "acts" in name]
    assert len(names) == 6
    for name in names:
        np.testing.assert_array_equal(fork.state[name], before.state[name])
    assert primordia.load(fork.path).verify() == []
