"""Invented lives with parents."""

import numpy as np

from primordia.law.world import BirthCause, Cause
from primordia.runs.lives import ALIVE, Lives

FOUNDER, COPY, MUTANT = BirthCause


def lives(*rows: tuple[int, BirthCause, int] | tuple[int, BirthCause, int, str]) -> Lives:
    """Return one world from (parent, cause of birth, lifespan so far); a fourth value: it is alive.

    Organisms are born one a tick, in the order of the rows.
    """
    count = len(rows)
    number = np.arange(count)
    lifespan = np.array([row[2] for row in rows])
    alive = np.array([len(row) == 4 for row in rows])
    return Lives(
        world=np.zeros(count, np.int32),
        id=number,
        parent=np.array([row[0] for row in rows]),
        cell=number.astype(np.int32),
        birth_cause=np.array([row[1] for row in rows], np.int8),
        born=number,
        seen=number,
        inherited=np.zeros(count, bool),
        ended=number + lifespan,
        cause=np.where(alive, ALIVE, Cause.FATAL).astype(np.int8),
    )
