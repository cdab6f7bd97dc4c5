"""Two kinds of extinctions: founders die out before they establish a population, or it crashes.

A world begins with founders, and begins again with new founders in the tick in which all organisms
have died. Most founders leave few descendants and die out. The number of these extinctions measures the
difficulty of a start. A crash is the loss of an established population. An extinction is a crash if
it follows a rise: since the last founders were born, organisms with parents have filled half of the
cells at the end of a tick. Founders do not count, since genesis may fill a world with founders.
"""

from typing import NamedTuple

import numpy as np

from primordia.history import series
from primordia.printable import counted
from primordia.runs.arrays import read_count
from primordia.runs.lives import Lives
from primordia.runs.records import Records

NAME = "world.worlds.extinctions"


class Extinctions(NamedTuple):
    """The extinctions of W worlds, each int64 (W,)."""

    total: np.ndarray
    """all extinctions"""
    crashes: np.ndarray
    """extinctions after a rise"""

    @property
    def text(self) -> str:
        """The number of crashes, and the number of worlds with a crash."""
        worlds = int((self.crashes > 0).sum())
        return f"{self.crashes.sum():,} in {counted(worlds, 'world')}" if worlds else "0"


def extinctions(worlds: list[Lives], cells: int) -> Extinctions:
    """Return the recorded extinctions of worlds with this number of cells.

    A rise before the beginning of the records, as in a fork, is not counted.
    """
    starts = [_starts(lives) for lives in worlds]
    total = [len(each) - 1 for each in starts]
    crashes = [_crashes(*each, cells) for each in zip(worlds, starts, strict=True)]
    return Extinctions(np.array(total, np.int64), np.array(crashes, np.int64))


def extinctions_of(run: Records) -> Extinctions:
    """Return the extinctions of each world of a run; in a fork, only those since the fork.

    Lives are read only if there were extinctions.
    """
    total = run.count(NAME).astype(np.int64)
    if run.origin is not None:
        total = total - read_count(run.origin, NAME).astype(np.int64)
    crashes = np.zeros(len(total), np.int64)
    if len(some := np.flatnonzero(total)):
        worlds = [run.lives.of_world(world) for world in some.tolist()]
        crashes[some] = extinctions(worlds, run.config.cells).crashes
    return Extinctions(total, crashes)


def _starts(lives: Lives) -> np.ndarray:
    """Return the ticks in which founders were born in a world, and the tick of the first birth."""
    founded = lives.born[lives.parent < 0]
    return np.unique(np.append(founded, lives.born[:1]))


def _crashes(lives: Lives, starts: np.ndarray, cells: int) -> int:
    """Return the number of a world's extinctions after a rise."""
    if len(starts) < 2:
        return 0
    children = lives.take(np.flatnonzero(lives.parent >= 0))
    risen = 2 * series.population(children, children.born) >= cells
    rises = np.unique(np.searchsorted(starts, children.born[risen], side="right"))
    return int((rises < len(starts)).sum())
