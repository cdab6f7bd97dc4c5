"""Lines of descent, told apart anew whenever one of them has taken the world over."""

from collections import Counter
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

    Founders begin a line, and children are of their parent's. Each of the living begins a line of
    its own, and lines are thereby told apart anew, after a tick that

    - leaves at least `crowd` alive for the first time since life began from nothing; or later,
    - leaves all of them in one line: it has taken the world over.

    This goes through all events in their order, since where lines begin depends on all before.

    Args:
        parent_row: row of each one's parent, or -1; int64 (L,), a parent before its children.
        born: tick of birth, int64 (L,), not falling.
        ended: tick of death, int64 (L,); of those that did not die it means nothing.
        died: who did, bool (L,).
        crowd: how many make a world worth telling lines apart in, at least 1.
    """
    dead = np.flatnonzero(died)
    dead = dead[np.argsort(ended[dead], kind="stable")]
    ticks = np.union1d(born, ended[dead])
    births_by = np.searchsorted(born, ticks, side="right").tolist()
    deaths_by = np.searchsorted(ended[dead], ticks, side="right").tolist()
    parents, dying = parent_row.tolist(), dead.tolist()

    line, first = list(range(len(parents))), list(range(len(parents)))
    living, size, young = set[int](), Counter[int](), True
    anew, takeover, births, deaths = [], [], 0, 0
    for tick, births_now, deaths_now in zip(ticks.tolist(), births_by, deaths_by, strict=True):
        for row in range(births, births_now):
            if parents[row] < 0:
                young = True
            else:
                first[row] = line[row] = line[parents[row]]
            size[line[row]] += 1
            living.add(row)
        for row in dying[deaths:deaths_now]:
            living.remove(row)
            size[line[row]] -= 1
            if not size[line[row]]:
                del size[line[row]]
        births, deaths = births_now, deaths_now
        if len(living) >= crowd if young else len(size) == 1:
            for row in living:
                line[row] = row
            size = Counter(living)
            anew.append(tick)
            takeover.append(not young)
            young = False
    return Lines(born, np.array(first), np.array(anew, np.int64), np.array(takeover, bool))
