"""The ancestors that live again before a life does, if children inherit memory."""

import numpy as np

from primordia.history.rebuilding import descent, rebuild_all
from primordia.runs.lives import Lives
from primordia.runs.records import Records


def line_of(run: Records, record: Lives) -> list[tuple[Lives, np.ndarray]]:
    """Return the records (1,) and genomes, float32 (P,), of an organism's ancestors, oldest first.

    The oldest is a founder, or the last ancestor that was alive at the fork that the run began with.
    """
    world, lives = int(record.world[0]), run.lives
    rows = descent(lives, int(record.id[0]), world)[:-1]
    at_fork = np.flatnonzero(is_older(run, lives.take(rows)))
    rows = rows[at_fork[-1] if len(at_fork) else 0 :]
    if not len(rows):
        return []
    genomes = rebuild_all(run, [(number, world) for number in lives.id[rows].tolist()])
    return [(lives.take(row), genome) for row, genome in zip(rows[:, None], genomes, strict=True)]


def is_older(run: Records, lives: Lives) -> np.ndarray:
    """Return which lives began before the fork that the run began with, or in its tick, bool (L,)."""
    return lives.born <= (-1 if run.config.fork is None else run.config.fork.tick)
