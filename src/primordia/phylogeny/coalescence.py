"""The genealogy of the living of one world: their common ancestor, and that of each pair.

Without selection, any two of the n organisms alive after a birth are the newborn and its parent
with probability 2 / (n (n - 1)) (Moran 1958; Kingman 1982). So the births and the sizes of the
population give the distribution of coalescence times that drift alone would have made.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from primordia.history.ancestry import places_of, with_ancestors
from primordia.phylogeny.living import Turnover
from primordia.runs.lives import Lives


@dataclass(frozen=True)
class Genealogy:
    """The living of one world at its end, and their ancestors, sorted by row; A is their number."""

    lives: Lives
    rows: np.ndarray
    """rows of the living and all their ancestors, int64 (A,)"""
    parent: np.ndarray
    """place of each organism's parent among `rows`, or -1, int64 (A,)"""
    size: np.ndarray
    """number of the living among each organism and its descendants, int64 (A,)"""
    merges: np.ndarray
    """for each organism, the number of pairs of the living whose lines part at its birth: one line goes
    through the organism, and the other one only through its parent"""

    @classmethod
    def of(cls, lives: Lives) -> "Genealogy":
        """Trace the genealogy of the living of one world."""
        rows = with_ancestors(np.flatnonzero(~lives.died), lives.parent_row)
        parent = places_of(rows, lives.parent_row[rows])
        size = (~lives.died[rows]).astype(int).tolist()
        merges = [0] * len(rows)
        for place, of in reversed(list(enumerate(parent.tolist()))):
            if of >= 0:  # the parent's size is still without this child and older ones
                merges[place] = size[of] * size[place]
                size[of] += size[place]
        return cls(lives, rows, parent, np.array(size, np.int64), np.array(merges, np.int64))

    @property
    def living(self) -> int:
        """Number of living."""
        return int((~self.lives.died).sum())

    @property
    def roots(self) -> np.ndarray:
        """Rows of the ancestors whose parents are not on record, int64."""
        return self.rows[self.parent < 0]

    @cached_property
    def common_ancestor(self) -> int | None:
        """Row of the youngest organism from which all the living descend; None if there is none."""
        common = self.rows[self.size == self.living]
        return int(common[-1]) if self.living and len(common) else None

    def trunk(self) -> np.ndarray:
        """Return the rows of the line with the most living descendants at its root and at each child."""
        if not len(self.rows):
            return np.zeros(0, np.int64)
        order = np.lexsort((self.size, self.parent))
        heir = np.full(len(self.rows) + 1, -1)
        heir[self.parent[order]] = order  # the last of a parent's children is the largest
        line = [int(heir[-1])]  # that of place -1: the largest root
        while heir[line[-1]] >= 0:
            line.append(int(heir[line[-1]]))
        return self.rows[line]

    def coalescences(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the ticks at which pairs of the living separate, latest first, and how many pairs do."""
        parted = np.flatnonzero(self.merges)[::-1]
        ticks = self.lives.born[self.rows[parted]]
        falling, place = np.unique(-ticks, return_inverse=True)
        pairs = np.zeros(len(falling), np.int64)
        np.add.at(pairs, place, self.merges[parted])
        return -falling, pairs


@dataclass(frozen=True)
class Times:
    """Coalescence times: ticks back from the end of a world to the common ancestors of pairs."""

    back: np.ndarray
    """int64 (K,), rising"""
    share: np.ndarray
    """share of pairs whose lines parted at most `back` ticks ago, float64 (K,), ascending"""

    @property
    def median(self) -> float | None:
        """The time that half of the pairs do not exceed; None if this time is before the records."""
        reached = np.flatnonzero(self.share >= 0.5)
        return float(self.back[reached[0]]) if len(reached) else None

    @property
    def mean(self) -> float | None:
        """The mean over pairs with a common ancestor on record; None if there is none."""
        if not len(self.share) or not self.share[-1]:
            return None
        return float(np.diff(self.share, prepend=0) @ self.back / self.share[-1])


def observed(genealogy: Genealogy) -> Times:
    """Return the exact coalescence times of all pairs of organisms that are alive in one world."""
    ticks, pairs = genealogy.coalescences()
    all_pairs = genealogy.living * (genealogy.living - 1) // 2
    return Times(_end(genealogy.lives) - ticks, pairs.cumsum() / max(all_pairs, 1))


def neutral(lives: Lives, turnover: Turnover) -> Times:
    """Return the coalescence times that drift alone would make, from births and population."""
    born = turnover.birth & (turnover.tick > lives.seen.min())  # since the fork, if it is one
    living = turnover.living[born].astype(float)
    own = lives.parent[turnover.row[born]] >= 0
    chance = np.where(own & (living >= 2), 2 / np.maximum(living * (living - 1), 2), 0.0)
    apart = np.cumprod(1 - chance[::-1])
    back = _end(lives) - turnover.tick[born][::-1]
    return Times(back, 1 - apart)


def _end(lives: Lives) -> int:
    return int(lives.ended.max())
