"""Lineages: the genome of any organism rebuilt from birth records alone, to the last bit."""

from collections.abc import Sequence

import numpy as np

from primordia.history import pedigree
from primordia.history.traits import factors_of
from primordia.law.world import BirthCause
from primordia.runs.lives import Lives
from primordia.runs.records import Records


def rebuild(run: Records, organism: int, world: int = 0) -> np.ndarray:
    """Return the genome of an organism, float32 (P,), with blocks of weights in the brain's order.

    Args:
        run: the organism's run.
        organism: birth number, `id` in the records.
        world: the organism's world.

    Raises:
        InputError: no such organism was born.
    """
    return rebuild_all(run, [(organism, world)])[0]


def rebuild_all(run: Records, organisms: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return the genomes of K organisms, by birth number and world, float32 (K, P); see `rebuild`."""
    return pedigree.genomes(run, np.array([run.lives.row(*each) for each in organisms], np.int64))


def descent(lives: Lives, organism: int, world: int) -> np.ndarray:
    """Return the rows of an organism's ancestors, oldest first, then its own row, int64 (D,).

    Raises:
        InputError: no such organism was born.
    """
    rows = [lives.row(organism, world)]
    while lives.birth_cause[rows[-1]] != BirthCause.FOUNDER:
        parent = int(lives.parent_row[rows[-1]])
        if parent < 0:  # the parent died before the fork that this run began with
            break
        rows.append(parent)
    return np.array(rows[::-1])


def changes(run: Records, organism: int, world: int = 0) -> np.ndarray:
    """Return the distance from the parent's genome to each genome on a line of descent, float64 (D, B).

    The distance is the Euclidean (L2) norm of the change in each block of weights. If there are two
    parents, the first one is meant. The distance is NaN if the parent's genome is unknown, as for
    founders and for organisms alive at a fork.

    Raises:
        InputError: no such organism was born, or the mutation is code that the user has not trusted.
    """
    rows = descent(run.lives, organism, world)
    found = np.full((len(rows), len(run.layout.names)), np.nan)
    made = run.layout.split(np.diff(pedigree.genomes(run, rows), axis=0))
    for place, block in enumerate(made.values()):
        axes = tuple(range(1, block.ndim))
        found[1:, place] = np.sqrt(np.square(block, dtype=np.float64).sum(axis=axes))
    found[run.lives.inherited[rows]] = np.nan
    return found


def bodies(run: Records, organism: int, world: int = 0) -> np.ndarray:
    """Return the traits of each organism on a line of descent, as factors, float64 (D, T).

    Raises:
        InputError: no such organism was born, or the mutation is code that the user has not trusted.
    """
    assert run.config.traits is not None
    rows = descent(run.lives, organism, world)
    return factors_of(run, run.config.traits, rows).astype(float)
