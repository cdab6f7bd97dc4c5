"""Lines of descent, followed event by event: in a living world, or through the records of one.

A founder begins a line; children are of their parent's. When a tick leaves a crowd alive for the first
time since a founder, each of the living begins a line; later, when a tick leaves all the living in
one line, it has taken over, and each of them begins a line. So the lines are what is left of one
moment's population, and how long chunks are does not matter.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from primordia.law.columns import Columns
from primordia.law.events import BIRTHS, DEATHS, Events, Rows

NOBODY, DIES = -1, -2
"""In place of a parent's number."""
CROWD = 16
"""The living that make a world worth telling lines apart in, or half its cells if that is less."""


class Turnover(NamedTuple):
    """Births and deaths of one world in the order of their ticks, int64."""

    born: np.ndarray
    """birth numbers, (B,)"""
    parent: np.ndarray
    """of each one born: its parent's number, or NOBODY for a founder"""
    born_at: np.ndarray
    """tick"""
    dead: np.ndarray
    """birth numbers, (D,)"""
    dead_at: np.ndarray
    """tick"""


class Lines:
    """Lines of the living of one world; a line bears the birth number of the one it began with."""

    def __init__(self, living: list[int], crowd: int) -> None:
        """Each of the `living`, by birth number, begins a line. Before genesis that is nobody."""
        self.of = {number: number for number in living}
        """line of everyone alive"""
        self.takeovers: list[int] = []
        """ticks after which one line was all that was left"""
        self.anew: list[int] = []
        """ticks after which each of the living began a line, takeovers among them"""
        self._size = dict.fromkeys(living, 1)
        self._crowd, self._young = crowd, len(living) < crowd

    def follow(self, turnover: Turnover) -> list[int]:
        """Live through what happened -> line that each one born was born into.

        In a tick births come first: parents may die in it.
        """
        now, first = -1, []
        for tick, number, parent in _in_order(turnover):
            if tick != now and now >= 0:
                self._end_of_tick(now)
            now = tick
            if parent == DIES:
                line = self.of.pop(number)
                if self._size[line] == 1:
                    del self._size[line]
                else:
                    self._size[line] -= 1
            elif parent == NOBODY:
                self._young = True
                self.of[number] = number
                self._size[number] = 1
                first.append(number)
            else:
                line = self.of[number] = self.of[parent]
                self._size[line] += 1
                first.append(line)
        if now >= 0:
            self._end_of_tick(now)
        return first

    def _end_of_tick(self, tick: int) -> None:
        if len(self.of) >= self._crowd if self._young else len(self._size) == 1:
            self.anew.append(tick)
            if not self._young:
                self.takeovers.append(tick)
            self.of = {number: number for number in self.of}
            self._size = dict.fromkeys(self.of, 1)
            self._young = False


def _in_order(turnover: Turnover) -> Iterator[tuple[int, int, int]]:
    """Tick, birth number, and parent or DIES."""
    born, parent, born_at, dead, dead_at = turnover
    ticks = np.concatenate([born_at, dead_at])
    order = np.argsort(ticks, kind="stable")
    parents = np.concatenate([parent, np.full(len(dead), DIES)])
    numbers = np.concatenate([born, dead])
    columns = (column[order].tolist() for column in (ticks, numbers, parents))
    return zip(*columns, strict=True)


def turnovers(events: Events, cells: int, worlds: int) -> list[Turnover]:
    """Return what a chunk's events say of each of the first `worlds` worlds, of `cells` cells each."""
    births = _by_world(events.births, BIRTHS, ("id", "parent", "tick"), cells, worlds)
    deaths = _by_world(events.deaths, DEATHS, ("id", "tick"), cells, worlds)
    return [Turnover(*born, *dead) for born, dead in zip(births, deaths, strict=True)]


def _by_world(
    list_: Rows, columns: Columns, names: tuple[str, ...], cells: int, worlds: int
) -> list[list[np.ndarray]]:
    """Return the named columns of each world; all ones are NOBODY."""
    found = columns.unpacked(np.asarray(list_.rows)[: int(list_.filled)])
    world = found["cell"] // cells
    return [[found[name][world == each] for name in names] for each in range(worlds)]
