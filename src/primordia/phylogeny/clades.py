"""Lines of descent, followed event by event in a running world or in its records.

A founder begins a line, and a child belongs to its parent's line. As soon as a crowd (see CROWD) is
alive at the end of a tick after a founder's birth, each of the living begins a line. If all the
living are in one line after a later tick, that line has taken over, and each of the living begins a
new line. So the lines descend from the population at one moment, and do not depend on the length of
chunks.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from primordia.errors import Trouble
from primordia.history import series
from primordia.law.columns import Columns
from primordia.law.events import BIRTHS, DEATHS, Events, Rows
from primordia.runs.lives import Lives

NO_PARENT, DIES = -1, -2
"""Numbers for a founder and for a death, in place of a parent's number."""
CROWD = 16
"""Number of living organisms at which lines begin; half the number of cells if that is less."""


class BirthsAndDeaths(NamedTuple):
    """Births and deaths of one world in the order of their ticks, int64."""

    born: np.ndarray
    """birth numbers, (B,)"""
    parent: np.ndarray
    """birth number of the parent, or NO_PARENT for a founder, (B,)"""
    born_at: np.ndarray
    """tick of each birth, (B,)"""
    dead: np.ndarray
    """birth numbers, (D,)"""
    dead_at: np.ndarray
    """tick of each death, (D,)"""


class Lines:
    """Lines of the living of one world; a line's number is the birth number of its first organism."""

    def __init__(self, living: list[int], crowd: int) -> None:
        """Begin a line with each of the `living` (birth numbers), of whom there are none before
        genesis."""
        self.line_of = {number: number for number in living}
        """birth number -> line, of each organism alive"""
        self.takeovers: list[int] = []
        """ticks after which only one line was left"""
        self.renewals: list[int] = []
        """ticks after which every living organism began a new line, takeovers included"""
        self._size = dict.fromkeys(living, 1)
        self._crowd, self._young = crowd, len(living) < crowd

    def follow(self, happened: BirthsAndDeaths) -> list[int]:
        """Follow births and deaths. Return the line that each newborn was born into.

        The births of a tick come first, since a parent may die in the same tick.

        Raises:
            Trouble: an organism has a child or dies while it is not alive.
        """
        try:
            return self._followed(happened)
        except KeyError:
            raise Trouble(
                "the records are damaged: an organism has a child or dies while it is not alive"
            ) from None

    def _followed(self, happened: BirthsAndDeaths) -> list[int]:
        now, birth_lines = -1, []
        for tick, number, parent in _in_order(happened):
            if tick != now and now >= 0:
                self._end_of_tick(now)
            now = tick
            if parent == DIES:
                line = self.line_of.pop(number)
                if self._size[line] == 1:
                    del self._size[line]
                else:
                    self._size[line] -= 1
            elif parent == NO_PARENT:
                self._young = True
                self.line_of[number] = number
                self._size[number] = 1
                birth_lines.append(number)
            else:
                line = self.line_of[number] = self.line_of[parent]
                self._size[line] += 1
                birth_lines.append(line)
        if now >= 0:
            self._end_of_tick(now)
        return birth_lines

    def _end_of_tick(self, tick: int) -> None:
        if len(self.line_of) >= self._crowd if self._young else len(self._size) == 1:
            self.renewals.append(tick)
            if not self._young:
                self.takeovers.append(tick)
            self.line_of = {number: number for number in self.line_of}
            self._size = dict.fromkeys(self.line_of, 1)
            self._young = False


def _in_order(happened: BirthsAndDeaths) -> Iterator[tuple[int, int, int]]:
    """Yield each birth and death as (tick, birth number, parent or DIES), by tick, births first."""
    born, parent, born_at, dead, dead_at = happened
    ticks = np.concatenate([born_at, dead_at])
    order = np.argsort(ticks, kind="stable")
    parents = np.concatenate([parent, np.full(len(dead), DIES)])
    numbers = np.concatenate([born, dead])
    columns = (column[order].tolist() for column in (ticks, numbers, parents))
    return zip(*columns, strict=True)


def births_and_deaths(events: Events, cells: int, worlds: int) -> list[BirthsAndDeaths]:
    """Return what happened in a chunk in each world below `worlds`; `cells` is the size of a world."""
    births = _split_by_world(events.births, BIRTHS, ("id", "parent", "tick"), cells, worlds)
    deaths = _split_by_world(events.deaths, DEATHS, ("id", "tick"), cells, worlds)
    return [BirthsAndDeaths(*born, *dead) for born, dead in zip(births, deaths, strict=True)]


def _split_by_world(
    events: Rows, columns: Columns, names: tuple[str, ...], cells: int, worlds: int
) -> list[list[np.ndarray]]:
    """Return the named columns of each world; a parent with all bits set is NO_PARENT."""
    values = columns.unpacked(np.asarray(events.rows)[: int(events.filled)])
    world_of = values["cell"] // cells
    return [[values[name][world_of == world] for name in names] for world in range(worlds)]


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


def clades_of(lives: Lives, crowd: int | None = None) -> Clades:
    """Follow the lines of descent in one world from its beginning.

    Args:
        lives: the lives of the world.
        crowd: lines begin when this number of organisms is alive; by default see `crowd_size`.
    """
    lines, dead = Lines([], crowd or crowd_size(lives)), np.flatnonzero(lives.died)
    rows = np.arange(len(lives))
    happened = BirthsAndDeaths(rows, lives.parent_row, lives.born, dead, lives.ended[dead])
    birth_line = lines.follow(happened)
    renewals = np.array(lines.renewals, np.int64)
    by_takeover = np.isin(renewals, lines.takeovers)
    return Clades(lives.born, np.array(birth_line, np.int64), renewals, by_takeover)


def crowd_size(lives: Lives) -> int:
    """Return how many organisms must be alive before lines begin: CROWD, or fewer in a small
    population."""
    most = int(series.population(lives, lives.born).max())
    return min(CROWD, max(most // 2, 1))
