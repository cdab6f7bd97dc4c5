"""Lines of descent, told apart anew whenever one of them has taken the world over."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Lines:
    """Who was of which line. A line is named by the row of the one that began it."""

    born: np.ndarray
    """tick of each one's birth, int64 (L,)"""
    first: np.ndarray
    """line each one was born into, int64 (L,)"""
    anew: np.ndarray
    """ticks that left each of the living with a line of its own, int64 (K,), rising"""
    takeover: np.ndarray
    """which of these were because one line had taken over, bool (K,)"""

    def of(self, rows: np.ndarray, ticks: np.ndarray) -> np.ndarray:
        """Line of each of `rows` after its tick, int64. The two broadcast; it must be alive then."""
        latest = np.append(self.anew, -1)[np.searchsorted(self.anew, ticks, side="right") - 1]
        return np.where(self.born[rows] <= latest, rows, self.first[rows])


def lines(
    parent_row: np.ndarray, born: np.ndarray, ended: np.ndarray, died: np.ndarray, crowd: int
) -> Lines:
    """Lines of descent in one world.

    Founders begin a line, and children are of their parent's. Lines are told apart anew, each of
    the living beginning one, after a tick that leaves at least `crowd` alive for the first time
    since life began from nothing; and later, after one that leaves all the living in one line: it
    has taken the world over. Where lines begin depends on all that was before, so this is one pass
    over all births and deaths in their order.

    Args:
        parent_row: row of each one's parent, or -1; int64 (L,), a parent before its children.
        born: tick of birth, int64 (L,), not falling.
        ended: tick of death, int64 (L,); of those that did not die it means nothing.
        died: who did, bool (L,).
        crowd: how many make a world worth telling lines apart in, at least 1.
    """
    parents, line = parent_row.tolist(), list(range(len(born)))
    first, living, size, young = line.copy(), set[int](), Counter[int](), True
    anew, takeover = [], []
    for tick, newborn, dying in _events(born, ended, died):
        for row in newborn:
            if parents[row] < 0:
                young = True
            else:
                first[row] = line[row] = line[parents[row]]
            size[line[row]] += 1
        for row in dying:
            size[line[row]] -= 1
            if not size[line[row]]:
                del size[line[row]]
        living.update(newborn)
        living.difference_update(dying)
        if len(living) >= crowd if young else len(size) == 1:
            for row in living:
                line[row] = row
            size = Counter(living)
            anew.append(tick)
            takeover.append(not young)
            young = False
    return Lines(born, np.array(first), np.array(anew, np.int64), np.array(takeover, bool))


def _events(
    born: np.ndarray, ended: np.ndarray, died: np.ndarray
) -> Iterator[tuple[int, range, list[int]]]:
    """Ticks with births or deaths, in order: the rows of those born, and of those who died."""
    dead = np.flatnonzero(died)
    dead = dead[np.argsort(ended[dead], kind="stable")]
    ticks = np.union1d(born, ended[dead])
    births = np.searchsorted(born, ticks, side="right").tolist()
    deaths = np.searchsorted(ended[dead], ticks, side="right").tolist()
    dying, was_born, was_dead = dead.tolist(), 0, 0
    for tick, by_birth, by_death in zip(ticks.tolist(), births, deaths, strict=True):
        yield tick, range(was_born, by_birth), dying[was_dead:by_death]
        was_born, was_dead = by_birth, by_death
