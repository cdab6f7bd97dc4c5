"""Children beside their parents, from the records of one world or of each world of a run."""

from dataclasses import dataclass

import numpy as np

from primordia.history.ancestry import children
from primordia.history.islands import born_on
from primordia.law.world import BirthCause
from primordia.runs.lives import LATE, Lives
from primordia.runs.records import Records

LEAST = 10
"""Smallest number of pairs of parent and child for a slope or a share."""


@dataclass(frozen=True)
class Families:
    """Children of a world with their parents, each (K,), without founders."""

    lives: Lives
    """all lives of the world"""
    born: np.ndarray
    """row of each birth that is considered, founders included, int64"""
    child: np.ndarray
    """row of each child in `lives`, int64"""
    parent: np.ndarray
    """row of the child's parent, int64"""
    mutant: np.ndarray
    """bool: the child is a mutant, otherwise a copy"""
    worth: np.ndarray
    """what is compared: ticks lived so far by each of the `lives`, or its children so far, int64 (L,)"""

    @property
    def lifespans(self) -> tuple[np.ndarray, np.ndarray]:
        """Ticks lived so far by child and parent, each int64 (K,)."""
        return self.lives.lifespan[self.child], self.lives.lifespan[self.parent]

    @property
    def complete(self) -> np.ndarray:
        """Whether child and parent are both dead, so that both lifespans are known, bool (K,)."""
        return self.lives.died[self.child] & self.lives.died[self.parent]

    def as_long(self) -> tuple[np.ndarray, np.ndarray]:
        """Return which children live at least as long as their parents, and which results are
        known; if `worth` is the number of children, which have at least as many.

        The result of a pair with a living organism is known in two cases. If only the parent is
        dead, the child counts as living at least as long once its age has reached the parent's
        lifespan. If only the child is dead, it counts as shorter-lived if it died younger than the
        parent is now.
        """
        child, parent = self.worth[self.child], self.worth[self.parent]
        longer = (child >= parent) & self.lives.died[self.parent]
        shorter = (child < parent) & self.lives.died[self.child]
        return longer, longer | shorter


def families(lives: Lives, after: float = LATE, acts: bool = False) -> Families:
    """Return the families of one world whose children were born late; see `Lives.late`."""
    return families_of(lives, np.flatnonzero(lives.late(after)), acts)


def families_by_world(
    run: Records, after: float = LATE, acts: bool = False, island: str | None = None
) -> list[Families]:
    """Return the families of each world whose children were born late.

    With an island, these are the families of which both parent and child were born on it. So both
    lived in the same habitat, and the children that an organism has elsewhere do not count.

    Raises:
        InputError: the worlds have no such island.
    """
    if island is None:
        return [families(lives, after, acts) for lives in run.lives.by_world()]
    native = np.flatnonzero(born_on(run, island))
    lives, late = run.lives.take(native), run.lives.late(after)[native]
    return [
        families_of(lives.of_world(world), np.flatnonzero(late[lives.world == world]), acts)
        for world in range(run.lives.worlds)
    ]


def families_of(lives: Lives, born: np.ndarray, acts: bool = False) -> Families:
    """Return the families of one world whose children are among the rows `born`, int64.

    Their worth is their lifespan, since all replicate at the same rate; if replication is an act, it is
    their number of children.
    """
    has_parent = (lives.birth_cause != BirthCause.FOUNDER) & (lives.parent_row >= 0)
    child = born[has_parent[born]]
    mutant = lives.birth_cause[child] == BirthCause.MUTANT
    worth = children(lives.parent_row) if acts else lives.lifespan
    return Families(lives, born, child, lives.parent_row[child], mutant, worth)
