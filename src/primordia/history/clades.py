"""Lines of descent throughout the recorded past of a world; the rule is that of `lines`."""

from dataclasses import dataclass

import numpy as np

from primordia.history.lines import Lines, Turnover


@dataclass(frozen=True)
class Clades:
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


def clades(
    parent_row: np.ndarray, born: np.ndarray, ended: np.ndarray, died: np.ndarray, crowd: int
) -> Clades:
    """Lines of descent in one world, from its beginning.

    Args:
        parent_row: row of each one's parent, or -1; int64 (L,), a parent before its children.
        born: tick of birth, int64 (L,), not falling.
        ended: tick of death, int64 (L,); of those that did not die it means nothing.
        died: who did, bool (L,).
        crowd: how many make a world worth telling lines apart in, at least 1.
    """
    lines, dead = Lines([], crowd), np.flatnonzero(died)
    first = lines.follow(Turnover(np.arange(len(born)), parent_row, born, dead, ended[dead]))
    anew = np.array(lines.anew, np.int64)
    return Clades(born, np.array(first, np.int64), anew, np.isin(anew, lines.takeovers))
