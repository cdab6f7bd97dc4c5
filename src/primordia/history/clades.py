"""Lines of descent at every tick of a world's records, by the rule of `lines`."""

from dataclasses import dataclass

import numpy as np

from primordia.history import series
from primordia.history.lines import CROWD, Lines, Turnover
from primordia.runs.lives import Lives


@dataclass(frozen=True)
class Clades:
    """The lines of L organisms. The number of a line is the row of the organism that began it."""

    born: np.ndarray
    """tick of each organism's birth, int64 (L,)"""
    birth_line: np.ndarray
    """line that each organism was born into, int64 (L,)"""
    renewals: np.ndarray
    """ticks after which every living organism began a new line, int64 (K,), in ascending order"""
    by_takeover: np.ndarray
    """whether the reason for a renewal was that one line had taken over, bool (K,)"""

    def lines_at(self, rows: np.ndarray, ticks: np.ndarray) -> np.ndarray:
        """Return the line of each organism in `rows` after its tick in `ticks`, int64.

        `rows` and `ticks` are broadcast against each other.
        """
        passed = np.searchsorted(self.renewals, ticks, side="right")
        latest = np.append(self.renewals, -1)[passed - 1]
        return np.where(self.born[rows] <= latest, rows, self.birth_line[rows])


def find_clades(
    parent_row: np.ndarray, born: np.ndarray, ended: np.ndarray, died: np.ndarray, crowd: int
) -> Clades:
    """Follow the lines of descent in one world from its beginning.

    Args:
        parent_row: row of each organism's parent, or -1; int64 (L,), parents before their children.
        born: tick of birth, int64 (L,), in ascending order.
        ended: tick of death, int64 (L,); not used for living organisms.
        died: whether the organism has died, bool (L,).
        crowd: lines begin when this number of organisms is alive; at least 1.
    """
    lines, dead = Lines([], crowd), np.flatnonzero(died)
    birth_line = lines.follow(Turnover(np.arange(len(born)), parent_row, born, dead, ended[dead]))
    renewals = np.array(lines.renewals, np.int64)
    by_takeover = np.isin(renewals, lines.takeovers)
    return Clades(born, np.array(birth_line, np.int64), renewals, by_takeover)


def crowd_size(lives: Lives) -> int:
    """Return how many organisms must be alive before lines begin: CROWD, or fewer in a small
    population."""
    most = int(series.population(lives, lives.born).max())
    return min(CROWD, max(most // 2, 1))
