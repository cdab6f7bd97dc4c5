"""Worlds in which children begin with what their parents have learned: lives are lived again.

`test_strange.py` tests the promises in the same worlds.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

import primordia
from primordia.history.rebuilding import descent
from primordia.law.world import Cause
from primordia.organism.reliving.compare import relive
from primordia.organism.reliving.course import Course, recorded
from primordia.organism.reliving.relived import RelivedLife
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.engine.test_strange import live_in_parts
from tests.strange import PASSING
from tests.worlds import MEADOW, Lived, config

LEARNING: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Clocked", "inner": "meadow"},
    "brain": {"kind": "plastic", "hidden": 1, "inherited": True},
    "cells": 60,
    "genesis": "fill",
    "replication": 0.5,
    "hazard": 0.1,
}
"""A small world on the host in which children begin with what their parents have learned."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("passing") / "run"
    live_in_parts(PASSING, path)
    return path


def generations(run: Archive) -> np.ndarray:
    """Return the number of ancestors of each organism up to its founder, or to the fork, (L,)."""
    lives, found = run.lives, np.zeros(len(run.lives), int)
    for row in np.argsort(lives.born, kind="stable"):
        if lives.parent_row[row] >= 0:
            found[row] = found[lives.parent_row[row]] + 1
    return found


def first_of(generation: np.ndarray, which: np.ndarray) -> int:
    """Return the row with the fewest ancestors, all of which live again."""
    (rows,) = which.nonzero()
    return int(rows[generation[rows].argmin()])


def life(run: Archive, row: int) -> RelivedLife:
    return RelivedLife.of(run, int(run.lives.id[row]), int(run.lives.world[row]))


def test_late_descendants_live_again_as_recorded(run: Path) -> None:
    """They die again in the recorded way, or reach the body, the energy and the memory on record."""
    opened = Archive(run)
    lives, generation = opened.lives, generations(opened)
    parents = lives.parent_row[lives.parent_row >= 0]
    replaced = np.isin(np.arange(len(lives)), parents[lives.cause[parents] == Cause.REPLACED])
    of_replaced = replaced[np.maximum(lives.parent_row, 0)] & (lives.parent_row >= 0)
    chosen = [~lives.died, lives.cause == Cause.STARVED, lives.cause == Cause.FATAL, of_replaced]
    for each in chosen:
        row = first_of(generation, each & (generation > 3) & (lives.lifespan > 0))
        found = relive(opened, int(lives.id[row]), int(lives.world[row]))
        assert found.agrees, found
        assert found.begin == "birth"


def test_a_life_that_begins_without_the_memory_of_its_parent_differs(run: Path) -> None:
    opened = Archive(run)
    lives = opened.lives
    generation = generations(opened)
    row = first_of(generation, ~lives.died & (generation > 1) & (lives.lifespan > 3))
    right = life(opened, row)
    wrong = replace(right, first=jnp.zeros_like(right.memory))
    assert right.memory.any()
    for each, same in ((right, True), (wrong, False)):
        list((course := Course(each)).stretches())
        assert (course.found()["memory"] == recorded(each)["memory"]) is same


def test_a_founder_begins_with_nothing(run: Path) -> None:
    opened = Archive(run)
    founders = np.flatnonzero(opened.lives.parent < 0)
    assert len(founders)
    assert not life(opened, founders[-1]).memory.any()


@pytest.mark.slow
def test_without_heredity_children_begin_with_nothing() -> None:
    lonely = Lived(config(LEARNING, inheritance="founder", habitat=MEADOW["habitat"]), 50)
    arrays = lonely.engine.arrays()
    memory, born = (arrays[f"world.organisms.{name}"] for name in ("memory", "born.lo"))
    new = born == 50
    assert 3 < new.sum() < len(new)
    assert memory[arrays["world.organisms.alive"] & ~new].any(axis=1).all()
    assert not memory[new].any()


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


@pytest.mark.slow
def test_descendants_on_the_host_live_again_as_recorded(tmp_path: Path) -> None:
    loop.start(config(LEARNING, stop={"ticks": 60}), tmp_path / "host")
    opened = Archive(tmp_path / "host")
    generation = generations(opened)
    right = life(opened, first_of(generation, ~opened.lives.died & (generation > 2)))
    for each, same in ((right, True), (replace(right, first=jnp.zeros_like(right.memory)), False)):
        list((course := Course(each)).stretches())
        assert (course.found()["memory"] == recorded(each)["memory"]) is same
