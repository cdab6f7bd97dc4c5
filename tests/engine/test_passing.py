"""Worlds in which children begin with what their parents have learned keep the promises."""

from dataclasses import replace
from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pytest

import primordia
from primordia.history.rebuilding import descent
from primordia.law.world import Cause
from primordia.organism.reliving.compare import relive
from primordia.organism.reliving.course import Course, recorded
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs.archive import Archive
from tests.engine.test_strange import digests, live_in_parts, on_host
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import PASSING, SEEDS, TICKS
from tests.worlds import Lived, config


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("passing") / "run"
    live_in_parts(PASSING, path)
    return path


def generations(run: Archive) -> np.ndarray:
    """Return the number of ancestors of each organism up to its founder, or to the fork, (L,)."""
    lives = run.lives
    return np.array(
        [len(descent(lives, *of)) - 1 for of in zip(lives.id, lives.world, strict=True)]
    )


def life(run: Archive, row: int) -> RelivedLife:
    return RelivedLife.of(run, int(run.lives.id[row]), int(run.lives.world[row]))


def test_parts_and_chunks_of_any_length_make_the_same_run(run: Path) -> None:
    whole = Lived(config(PASSING), TICKS, chunk=11)
    assert digests(run) == whole.digests()
    assert primordia.load(run).verify() == []
    assert_rebuilt(run)
    alone = Lived(config(PASSING, seed=SEEDS[1], seeds=1), TICKS)
    assert alone.digests() == whole.digests()[1:]


def test_late_descendants_live_again_as_recorded(run: Path) -> None:
    """They die again in the recorded way, or reach the body, the energy and the memory on record."""
    opened = Archive(run)
    lives, late = opened.lives, generations(opened) > 3
    parents = lives.parent_row[lives.parent_row >= 0]
    replaced = np.isin(np.arange(len(lives)), parents[lives.cause[parents] == Cause.REPLACED])
    of_replaced = replaced[np.maximum(lives.parent_row, 0)] & (lives.parent_row >= 0)
    chosen = [~lives.died, lives.cause == Cause.STARVED, lives.cause == Cause.FATAL, of_replaced]
    for each in chosen:
        rows = np.flatnonzero(each & late & (lives.lifespan > 0))
        assert len(rows)
        for row in rows[[0, -1]]:
            found = relive(opened, int(lives.id[row]), int(lives.world[row]))
            assert found.agrees, found
            assert found.begin == "birth"


def test_a_life_that_begins_without_the_memory_of_its_parent_differs(run: Path) -> None:
    opened = Archive(run)
    lives = opened.lives
    (row, *_) = np.flatnonzero(~lives.died & (generations(opened) > 1) & (lives.lifespan > 3))
    right = life(opened, row)
    wrong = replace(right, first=jnp.zeros_like(right.memory))
    assert right.memory.any()
    for each, same in ((right, True), (wrong, False)):
        list((course := Course(each)).stretches())
        assert (course.found()["memory"] == recorded(each)["memory"]) is same


def test_a_founder_and_a_child_without_heredity_begin_with_nothing(run: Path) -> None:
    opened = Archive(run)
    founders = np.flatnonzero(opened.lives.parent < 0)
    assert len(founders)
    assert not life(opened, founders[-1]).memory.any()
    lonely = Lived(config(PASSING, inheritance="founder", recombination=None), 100)
    memory = lonely.engine.arrays()["world.organisms.memory"]
    born = lonely.engine.arrays()["world.organisms.born.lo"]
    assert not memory[born == 100].any()


def test_descendants_of_those_alive_at_a_fork_live_again(run: Path, tmp_path: Path) -> None:
    fork = primordia.load(run).fork(150, tmp_path / "fork", stop={"ticks": 230})
    opened = Archive(fork.path)
    lives = opened.lives
    after = (generations(opened) > 1) & (lives.born > 150) & (lives.lifespan > 0)
    rows = np.flatnonzero(after)
    older = [descent(lives, int(lives.id[row]), int(lives.world[row]))[0] for row in rows]
    rows = rows[lives.inherited[older]]
    assert len(rows) > 5
    for row in (*rows[:2], *rows[-2:]):
        assert relive(opened, int(lives.id[row]), int(lives.world[row])).agrees


def test_a_habitat_on_the_host_lives_under_the_same_law(run: Path, tmp_path: Path) -> None:
    host = tmp_path / "host"
    live_in_parts(on_host(PASSING, "Clocked"), host)
    a, b = Archive(host).state, Archive(run).state
    alive = b["world.organisms.alive"]
    names = [name for name in b if name.startswith("world.organisms")]
    for name in names:
        np.testing.assert_array_equal(a[name][alive], b[name][alive], err_msg=name)
    opened = Archive(host)
    rows = np.flatnonzero((generations(opened) > 3) & (opened.lives.lifespan > 0))
    for row in (rows[len(rows) // 2], rows[-1]):
        assert relive(opened, int(opened.lives.id[row]), int(opened.lives.world[row])).agrees
