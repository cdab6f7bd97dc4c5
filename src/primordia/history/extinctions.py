"""Extinctions told apart: founders that never rose, and crashes after a rise.

A world begins with founders, and again with others in the tick in which all have died. Most founders
leave few descendants and die out; that says how hard a start is. A crash says that life which had
established itself was lost. So an extinction is a crash if organisms with parents had filled half of the
cells at the end of some tick since the founders. Founders do not count, since they may fill a world
themselves.
"""

from typing import NamedTuple

import numpy as np

from primordia.history import series
from primordia.runs.arrays import read_count
from primordia.runs.lives import Lives
from primordia.runs.records import Records

NAME = "world.worlds.extinctions"


class Extinctions(NamedTuple):
    """The extinctions of W worlds, int64 (W,) each."""

    total: np.ndarray
    """all of them"""
    crashes: np.ndarray
    """those after a rise"""

    @property
    def text(self) -> str:
        """The number of crashes, and of the worlds that had any."""
        worlds = int((self.crashes > 0).sum())
        many = "1 world" if worlds == 1 else f"{worlds:,} worlds"
        return f"{self.crashes.sum():,} in {many}" if worlds else "0"


def extinctions(worlds: list[Lives], cells: int) -> Extinctions:
    """Return the extinctions on record of some worlds, of a number of cells each.

    In the record of a fork, or one that is cut, a rise before its beginning is not seen.
    """
    starts = [_starts(lives) for lives in worlds]
    total = [len(each) - 1 for each in starts]
    crashes = [_crashes(*each, cells) for each in zip(worlds, starts, strict=True)]
    return Extinctions(np.array(total, np.int64), np.array(crashes, np.int64))


def crashes(run: Records) -> np.ndarray:
    """Return the crashes of each world of a run, int64 (W,): in a fork, those since it was forked.

    If there were no extinctions, lives are not read.
    """
    died_out = run.count(NAME).astype(np.int64)
    if run.origin is not None:
        died_out = died_out - read_count(run.origin, NAME).astype(np.int64)
    crashed = np.zeros(len(died_out), np.int64)
    if len(some := np.flatnonzero(died_out)):
        worlds = [run.lives.of_world(world) for world in some.tolist()]
        crashed[some] = extinctions(worlds, run.config.cells).crashes
    return crashed


def _starts(lives: Lives) -> np.ndarray:
    """Return the ticks in which founders came into a world; the first is that of its first life."""
    founded = lives.born[lives.parent < 0]
    return np.unique(np.append(founded, lives.born[:1]))


def _crashes(lives: Lives, starts: np.ndarray, cells: int) -> int:
    """Return how often a world fell to the last organism between two starts, after a rise."""
    if len(starts) < 2:
        return 0
    children = lives.take(np.flatnonzero(lives.parent >= 0))
    risen = 2 * series.population(children, children.born) >= cells
    rises = np.unique(np.searchsorted(starts, children.born[risen], side="right"))
    return int((rises < len(starts)).sum())
