"""Parts of a phylogeny: the ancestors of some organisms, and the branching points alone."""

from dataclasses import replace

import numpy as np

from primordia.errors import InputError
from primordia.history.ancestry import children, nearest, with_ancestors
from primordia.phylogeny.phylogeny import Phylogeny


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
        world: only this world; if `organism` is given, world 0 by default.
        extant: only the living and their ancestors.
        collapse: without organisms on unbranched stretches; see `_collapsed`.

    Raises:
        InputError: there is no such organism or world, or the choices contradict each other.
    """
    if organism is not None and extant:
        raise InputError("an organism's ID and --extant exclude each other; give one of them")
    part = whole
    if organism is not None or world is not None:
        whole.lives.check_world(world or 0)
        rows = np.flatnonzero(whole.lives.world == (world or 0))
        part = whole.take(slice(int(rows[0]), int(rows[-1]) + 1))
    if organism is not None:
        part = _with_ancestors(part, np.array([part.lives.row(organism, world or 0)]))
    elif extant:
        part = _with_ancestors(part, np.flatnonzero(~part.lives.died))
    return _collapsed(part) if collapse else part


def _collapsed(whole: Phylogeny) -> Phylogeny:
    """Return the phylogeny without dead organisms that have a parent and one child.

    The child becomes a child of the nearest ancestor that remains.

    Raises:
        InputError: organisms have two parents.
    """
    if whole.mates:
        raise InputError(
            "--collapse is for runs without recombination: in this run children have two parents"
        )
    lives, parent = whole.lives, whole.lives.parent_row
    passed = lives.died & (parent >= 0) & (children(parent) == 1)
    ancestor = np.where(parent < 0, -1, lives.id[nearest(parent, np.flatnonzero(~passed))[parent]])
    kept = replace(whole, lives=replace(lives, parent=ancestor))
    return kept.take(np.flatnonzero(~passed))


def _with_ancestors(whole: Phylogeny, rows: np.ndarray) -> Phylogeny:
    """Return organisms and all their ancestors, through both parents."""
    parents = [whole.lives.parent_row, *([] if whole.mate_row is None else [whole.mate_row])]
    return whole.take(with_ancestors(rows, *parents))
