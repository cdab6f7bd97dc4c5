"""Parts of a phylogeny: the ancestors of some organisms, and the branching points alone."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from primordia.errors import InputError
from primordia.phylogeny.phylogeny import Phylogeny

AT_ONCE = 2**16
"""Rows that are Python numbers at the same time."""


def chosen(
    whole: Phylogeny,
    organism: int | None = None,
    world: int | None = None,
    extant: bool = False,
    collapse: bool = False,
) -> Phylogeny:
    """Return a part of a phylogeny.

    Args:
        whole: the phylogeny.
        organism: birth number; only this organism and its ancestors.
        world: only this world; the organism's is 0 by default.
        extant: only the living and their ancestors.
        collapse: without organisms on unbranched stretches; see `collapsed`.

    Raises:
        InputError: there is no such organism or world, or the choices contradict each other.
    """
    if organism is not None and extant:
        raise InputError("an organism and --extant both choose the last of each line; give one")
    part = whole if organism is None and world is None else of_world(whole, world or 0)
    if organism is not None:
        part = line_of(part, organism, world or 0)
    elif extant:
        part = living_lines(part)
    return collapsed(part) if collapse else part


def of_world(whole: Phylogeny, world: int) -> Phylogeny:
    """Return the organisms of one world.

    Raises:
        InputError: nothing was born there.
    """
    rows = np.flatnonzero(whole.lives.world == world)
    if not len(rows):
        last = whole.lives.worlds - 1
        raise InputError(f"nothing was born in world {world}; the worlds are 0 to {last}")
    return whole.take(slice(int(rows[0]), int(rows[-1]) + 1))


def living_lines(whole: Phylogeny) -> Phylogeny:
    """Return the living and all their ancestors."""
    return whole.take(np.flatnonzero(_with_ancestors(whole, ~whole.lives.died)))


def line_of(whole: Phylogeny, organism: int, world: int) -> Phylogeny:
    """Return an organism and all its ancestors, by birth number.

    Raises:
        InputError: no such organism was born.
    """
    chosen = np.zeros(len(whole), bool)
    chosen[whole.lives.row(organism, world)] = True
    return whole.take(np.flatnonzero(_with_ancestors(whole, chosen)))


def collapsed(whole: Phylogeny) -> Phylogeny:
    """Return the phylogeny without the dead that have a parent and one child: that child is its parent's.

    Raises:
        InputError: organisms have two parents.
    """
    if whole.mates:
        raise InputError(
            "--collapse is for runs without recombination: here a child has two parents"
        )
    lives, parent = whole.lives, whole.lives.parent_row
    children = np.bincount(parent[parent >= 0], minlength=len(whole))
    passed = lives.died & (parent >= 0) & (children == 1)
    nearest = np.where(passed, parent, np.arange(len(whole)))
    while passed[nearest].any():  # each round doubles the number of steps
        nearest = nearest[nearest]
    ancestor = np.where(parent < 0, -1, lives.id[nearest[parent]])
    kept = replace(whole, lives=replace(lives, parent=ancestor))
    return kept.take(np.flatnonzero(~passed))


def _with_ancestors(whole: Phylogeny, chosen: np.ndarray) -> np.ndarray:
    """Return which organisms are chosen or ancestors of chosen ones, bool (L,)."""
    kept = bytearray(chosen.tobytes())
    parents = [whole.lives.parent_row, *([] if whole.mate_row is None else [whole.mate_row])]
    for rows in _from_last(len(whole)):
        for row, *older in zip(rows, *(each[rows].tolist() for each in parents), strict=True):
            if kept[row]:
                for parent in older:
                    if parent >= 0:
                        kept[parent] = True
    return np.frombuffer(kept, bool)


def _from_last(count: int) -> Iterator[range]:
    """Yield the rows from the last to the first, some at a time."""
    for stop in range(count, 0, -AT_ONCE):
        yield range(stop - 1, max(stop - AT_ONCE, 0) - 1, -1)
