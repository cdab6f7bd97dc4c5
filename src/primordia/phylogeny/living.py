"""The living of one world after chosen ticks, and the turnover between them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from primordia.history.ancestry import nearest, places_of
from primordia.runs.lives import Lives

NEVER = np.iinfo(np.int64).max
"""The number for the living, in place of a tick of death."""


def stops(lives: Lives) -> np.ndarray:
    """Return the tick from which each organism is no longer alive, int64 (L,); NEVER for the living."""
    return np.where(lives.died, lives.ended, NEVER)


def last_era(lives: Lives) -> Lives:
    """Return the lives of one world since it was last founded: at the beginning, or after extinction.

    A world that dies out is founded again in the same tick, so the last founders mark its beginning.
    """
    rootless = np.flatnonzero(lives.parent < 0)
    if not len(rootless):  # a fork of a world whose founders are dead
        return lives
    first = np.searchsorted(lives.born[rootless], lives.born[rootless[-1]])
    return lives.take(slice(int(rootless[first]), None))


def branches(parent_row: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Return the place of the nearest of some organisms on each organism's line of descent, int64 (L,).

    It is -1 if there is none. If the organisms are a line of descent, the place is where each
    organism's own line leaves it. If they began lines at one tick, it is each organism's line: a child
    belongs to its parent's line, and to the line of the first parent if it has two.

    Args:
        parent_row: row of each parent, or -1, int64 (L,).
        chosen: rows of the organisms, in ascending order, int64 (D,).
    """
    return places_of(chosen, nearest(parent_row, chosen))


@dataclass(frozen=True)
class Census:
    """The living of one world after each of T ticks in order; A counts the pairs of tick and organism."""

    lives: Lives
    ticks: np.ndarray
    """int64 (T,), rising"""

    @cached_property
    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """The place of a tick, and the row of an organism alive after that tick, int64 (A,) each."""
        first = np.searchsorted(self.ticks, self.lives.born)
        past = np.searchsorted(self.ticks, stops(self.lives))
        rows = np.flatnonzero(past > first)
        spans = (past - first)[rows]
        begun = np.repeat(np.cumsum(spans) - spans, spans)
        places = np.repeat(first[rows], spans) + np.arange(spans.sum()) - begun
        return places, np.repeat(rows, spans)

    @cached_property
    def living(self) -> np.ndarray:
        """Number of living after each tick, int64 (T,)."""
        return np.bincount(self.pairs[0], minlength=len(self.ticks))

    def counts(self, groups: np.ndarray, number: int) -> np.ndarray:
        """Count the living of each group after each tick, int64 (T, number).

        Args:
            groups: group of each organism, int (L,), from 0 to `number` - 1; -1 for no group.
            number: number of groups.
        """
        places, rows = self.pairs
        group = groups[rows]
        codes = (places * number + group)[group >= 0]
        return np.bincount(codes, minlength=len(self.ticks) * number).reshape(-1, number)


@dataclass(frozen=True)
class Turnover:
    """Births and deaths of one world in the order of their ticks, (E,) each.

    In a tick children are born first, since a parent may die in the same tick. Then organisms die.
    Founders come last: a world is founded again in the tick in which it dies out.
    """

    tick: np.ndarray
    """int64, never decreasing"""
    row: np.ndarray
    """row of the organism, int64"""
    birth: np.ndarray
    """bool: the organism is born; otherwise it dies"""

    @classmethod
    def of(cls, lives: Lives) -> "Turnover":
        """Return the turnover of one world."""
        dead = np.flatnonzero(lives.died)
        dead = dead[np.argsort(lives.ended[dead], kind="stable")]
        founder = lives.parent < 0
        parts = np.flatnonzero(~founder), dead, np.flatnonzero(founder)
        tick = np.concatenate([lives.born[parts[0]], lives.ended[dead], lives.born[parts[2]]])
        birth = np.repeat([True, False, True], list(map(len, parts)))
        order = np.argsort(tick, kind="stable")
        return cls(tick[order], np.concatenate(parts)[order], birth[order])

    @cached_property
    def living(self) -> np.ndarray:
        """Number of living after each birth or death, int64 (E,)."""
        return np.cumsum(np.where(self.birth, 1, -1))

    @cached_property
    def closes(self) -> np.ndarray:
        """Whether each birth or death is the last of its tick, bool (E,)."""
        return np.append(self.tick[1:] > self.tick[:-1], True)
