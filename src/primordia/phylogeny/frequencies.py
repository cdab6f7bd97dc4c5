"""Lines of a world, begun by the organisms alive at a tick, and the ticks at which they are counted."""

import numpy as np

from primordia.errors import InputError
from primordia.phylogeny.clades import crowd_size
from primordia.phylogeny.living import Census, Turnover, last_era
from primordia.runs.lives import Lives

INSTANTS = 300
"""Largest number of instants at which lines are counted."""


def founding_tick(lives: Lives) -> int:
    """Return the tick after which lines of one world are founded if no tick is given.

    It is the first tick since the last extinction, or since the fork, after which a crowd is alive;
    see `crowd_size`. In a world whose cells are filled with founders, it is the tick of their
    birth.
    """
    era = last_era(lives)
    turnover, begin = Turnover.of(era), int(era.seen.min())
    crowd = turnover.closes & (turnover.living >= crowd_size(era))
    crowd[: np.searchsorted(turnover.tick, begin, side="right") - 1] = False  # before the fork
    return max(int(turnover.tick[crowd.argmax()]), begin)


def instants(at: int, last: int) -> np.ndarray:
    """Return int64 (T,): ticks from tick `at` to tick `last`, denser early, when most lines are lost."""
    after = np.geomspace(1, max(last - at, 1), INSTANTS).round().astype(np.int64)
    return np.unique(np.concatenate([[at], at + after[at + after <= last]]))


def founders(lives: Lives, at: int) -> np.ndarray:
    """Return the rows of the organisms of one world that are alive after a tick, int64 (K,).

    Raises:
        InputError: the tick is not on record, or nothing is alive after it.
    """
    first, last = int(lives.seen.min()), int(lives.ended.max())
    if not first <= at <= last:
        raise InputError(f"--at: tick {at:,} is not on record; the ticks are {first:,} to {last:,}")
    rows = Census(lives, np.array([at])).pairs[1]
    if not len(rows):
        raise InputError(f"--at: nothing is alive after tick {at:,}, so no line begins there")
    return rows
