"""Lines of descent of one run: the rows, genomes and bodies of an organism's ancestors."""

import numpy as np

from primordia.history import pedigree
from primordia.history.traits import factors_of
from primordia.law.world import BirthCause
from primordia.runs.lives import Lives
from primordia.runs.records import Records


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


def ancestors(run: Records, record: Lives) -> list[tuple[Lives, np.ndarray]]:
    """Return the records (1,) and genomes, float32 (P,), of an organism's ancestors, oldest first.

    The oldest is a founder, or the last ancestor that was alive at the fork that the run began with.

    Args:
        run: the organism's run.
        record: the organism's own record, (1,).
    """
    lives = run.lives
    rows = descent(lives, int(record.id[0]), int(record.world[0]))[:-1]
    at_fork = np.flatnonzero(lives.inherited[rows])
    rows = rows[at_fork[-1] if len(at_fork) else 0 :]
    genomes = pedigree.genomes(run, rows)
    return [(lives.take(row), genome) for row, genome in zip(rows[:, None], genomes, strict=True)]


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
