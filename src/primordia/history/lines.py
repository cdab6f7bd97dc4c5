"""Lines of descent, followed event by event in a running world or in its records.

A founder begins a line, and a child belongs to its parent's line. As soon as a crowd (see CROWD) is
alive at the end of a tick after a founder's birth, each of the living begins a line. If all the
living are in one line after a later tick, that line has taken over, and each of the living begins a
new line. So the lines descend from the population at one moment, and do not depend on the length of
chunks.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from primordia.errors import Trouble
from primordia.law.columns import Columns
from primordia.law.events import BIRTHS, DEATHS, Events, Rows

NO_PARENT, DIES = -1, -2
"""Numbers for a founder and for a death, in place of a parent's number."""
CROWD = 16
"""Number of living organisms at which lines begin; half the number of cells if that is less."""


class Turnover(NamedTuple):
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

    def follow(self, turnover: Turnover) -> list[int]:
        """Follow births and deaths. Return the line that each newborn was born into.

        The births of a tick come first, since a parent may die in the same tick.

        Raises:
            Trouble: an organism has a child or dies while it is not alive.
        """
        try:
            return self._followed(turnover)
        except KeyError:
            raise Trouble(
                "the records are damaged: an organism has a child or dies while it is not alive"
            ) from None

    def _followed(self, turnover: Turnover) -> list[int]:
        now, birth_lines = -1, []
        for tick, number, parent in _in_order(turnover):
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


def _in_order(turnover: Turnover) -> Iterator[tuple[int, int, int]]:
    """Yield each birth and death as (tick, birth number, parent or DIES), by tick, births first."""
    born, parent, born_at, dead, dead_at = turnover
    ticks = np.concatenate([born_at, dead_at])
    order = np.argsort(ticks, kind="stable")
    parents = np.concatenate([parent, np.full(len(dead), DIES)])
    numbers = np.concatenate([born, dead])
    columns = (column[order].tolist() for column in (ticks, numbers, parents))
    return zip(*columns, strict=True)


def turnovers(events: Events, cells: int, worlds: int) -> list[Turnover]:
    """Return a chunk's turnover of each world numbered below `worlds`; `cells` is a world's size."""
    births = _split_by_world(events.births, BIRTHS, ("id", "parent", "tick"), cells, worlds)
    deaths = _split_by_world(events.deaths, DEATHS, ("id", "tick"), cells, worlds)
    return [Turnover(*born, *dead) for born, dead in zip(births, deaths, strict=True)]


def _split_by_world(
    events: Rows, columns: Columns, names: tuple[str, ...], cells: int, worlds: int
) -> list[list[np.ndarray]]:
    """Return the named columns of each world; a parent with all bits set is NO_PARENT."""
    values = columns.unpacked(np.asarray(events.rows)[: int(events.filled)])
    world_of = values["cell"] // cells
    return [[values[name][world_of == world] for name in names] for world in range(worlds)]
