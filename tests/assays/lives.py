"""Invented lives with parents."""

import numpy as np

from primordia.law.world import BirthCause
from primordia.runs.lives import Lives
from tests.synthetic import one_world

FOUNDER, COPY, MUTANT = BirthCause


def lives(*rows: tuple[int, BirthCause, int] | tuple[int, BirthCause, int, str]) -> Lives:
    """Return one world from (parent, cause of birth, lifespan so far); a fourth value: it is alive.

    Organisms are born one a tick, in the order of the rows.
    """
    number = np.arange(len(rows))
    parent, birth, lifespan = (np.array([row[at] for row in rows]) for at in range(3))
    died = [len(row) == 3 for row in rows]
    return one_world(number, number + lifespan, died, parent, birth_cause=birth.astype(np.int8))
