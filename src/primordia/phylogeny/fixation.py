"""How the descendants of each ancestor on a line spread among the living, exact to the tick."""

from collections.abc import Sequence

import numpy as np

from primordia.phylogeny.living import NEVER, Turnover

SPANS = 256, 2048
"""Smallest and largest number of births and deaths in one step."""
UNKNOWN = -1
"""Number in place of a tick that has not come."""


def first_ticks(
    turnover: Turnover, branch: np.ndarray, length: int, shares: Sequence[float]
) -> list[np.ndarray]:
    """Return, for each ancestor and share, the first tick after which its descendants exceed the share.

    The lines of an ancestor's descendants leave the line of descent at the ancestor's place or
    later. So an ancestor reaches a share no earlier than the ancestor before it, and one pass over
    the births and deaths is enough.

    Args:
        turnover: births and deaths of the world.
        branch: place where each organism's line leaves the line of descent, int64 (L,); see `branches`.
        length: D, the number of ancestors on the line.
        shares: each from 0 to below 1, or 1 for all of the living.

    Returns:
        For each share, the ticks, or UNKNOWN for a share not yet exceeded, int64 (D,).
    """
    looks = [_Look(turnover, share, length) for share in shares]
    alive = np.zeros(length + 1, np.int32)  # of one type with `change`: add.at is fast then
    # Each pass over a part finds the tick of one ancestor, so parts have a few ancestors each.
    events = len(turnover.row)
    span = int(np.clip(4 * events // max(length, 1), *SPANS))
    for first in range(0, events, span):
        part = slice(first, first + span)
        at = branch[turnover.row[part]]
        change = np.where(turnover.birth[part], np.int32(1), np.int32(-1))
        for look in looks:
            look.follow(part, at, change, alive)
        np.add.at(alive, at, change)  # place -1 is the last, which is never read
    return [look.ticks for look in looks]


class _Look:
    """Finds the tick at which each ancestor's descendants exceed a share, one ancestor after another."""

    def __init__(self, turnover: Turnover, share: float, length: int) -> None:
        self._turnover, self._share = turnover, share
        self.ticks = np.full(length, UNKNOWN)
        self._next, self._above = 0, 0  # the next ancestor, and its descendants before a part

    def follow(self, part: slice, at: np.ndarray, change: np.ndarray, alive: np.ndarray) -> None:
        """Follow a part of the births and deaths.

        `alive[i]` is the number of organisms, living before this part, whose lines leave the line
        of descent at place i.
        """
        needed, next_ = self._needed(part), self._next
        while next_ < len(self.ticks):
            own = at >= next_
            counts = np.cumsum(change * own, dtype=np.int32)
            reached = counts >= needed - self._above
            first = reached.argmax()
            if not reached[first]:
                self._above += int(counts[-1])
                break
            self.ticks[next_] = self._turnover.tick[part.start + first]
            self._above -= int(alive[next_])
            next_ += 1
        self._next = next_

    def _needed(self, part: slice) -> np.ndarray:
        """Return how many descendants exceed the share after each birth or death, if it ends its tick."""
        living = self._turnover.living[part]
        needed = living if self._share == 1 else np.floor(self._share * living).astype(np.int64) + 1
        return np.where(self._turnover.closes[part] & (living > 0), needed, NEVER)
