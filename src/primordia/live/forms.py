"""The forms of worlds: a ring as a skyline with its past below, a torus as a picture.

Both forms have:

    age: how age is shown
    least: smallest numbers of columns and rows of characters in which all cells can be drawn
    scale: the width of a cell in a room, in columns; 0 if there is no room for all cells
    draw: all cells of a world as rows in a room, and words on the part that is shown if not all are;
        `past` has the shades of the cells at earlier moments, the latest first
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from primordia.law.law import Law
from primordia.live.borders import bracketed, edge, ruler
from primordia.live.paint import Cells, Row, field, mosaic, skyline
from primordia.settings.islands import Islands

TALLEST = 4
"""Largest number of rows of a skyline."""
WIDEST = 8
"""Largest number of columns of a cell."""


class Room(NamedTuple):
    """The room for a drawing, in characters."""

    width: int
    height: int


def form_of(law: Law) -> "Ring | Torus":
    """Return the form of a law's worlds. In a well-mixed world the places have no meaning."""
    rows, columns = law.placement.shape(law.cells)
    islands = law.islands if law.islands.count > 1 else None
    return Ring(law.cells, islands) if rows == 1 else Torus(rows, columns, islands)


@dataclass(frozen=True)
class Ring:
    """Cells as a skyline. Many cells make several skylines. A single skyline has its past below it."""

    cells: int
    islands: Islands | None = None
    """a row below a skyline shows their borders; None: a plain world"""
    age: ClassVar[str] = "height: age"

    @property
    def least(self) -> tuple[int, int]:
        """A row of cells."""
        return self.cells, 1

    def scale(self, room: Room) -> int:
        """Return the width of a cell, in columns; 0 if there is no room for all cells."""
        return min(room.width // self.cells, WIDEST) if room.height else 0

    def draw(self, cells: Cells, past: Sequence[np.ndarray], room: Room) -> tuple[list[Row], str]:
        """Return all cells in order as rows, and words on the part that is shown if not all are."""
        wide = max(self.scale(room), 1)
        most = max(room.height, 1)
        count = min(-(-self.cells * wide // (room.width // wide * wide)), most)
        across = min(-(-self.cells // count), room.width // wide)
        shown = min(across * count, self.cells)
        gap = 1 if count > 1 or self.islands else 0
        tall = min(max(room.height // count - gap, 1), TALLEST)
        with_gaps = gap and count * (tall + 1) - (0 if self.islands else 1) <= room.height
        rows: list[Row] = []
        for at in range(0, shown, across):
            if with_gaps and rows and not self.islands:
                rows.append([])
            end = min(at + across, shown)
            rows += skyline(cells.take(slice(at, end)), wide, tall)
            if with_gaps and self.islands:
                rows.append(ruler(self.islands, at, end, wide))
        left = room.height - len(rows)
        if count == 1:
            earlier = [moment[:shown].repeat(wide) for moment in past[: 2 * left]]
            drawn = mosaic(np.stack(earlier)) if earlier else []
            rows += [*drawn, *[[]] * (left - len(drawn))]
        return rows, part_of(shown, self.cells)


@dataclass(frozen=True)
class Torus:
    """Cells as a picture."""

    rows: int
    columns: int
    islands: Islands | None = None
    """brackets beside the picture show them; None: a plain world"""
    age: ClassVar[str] = "light: age"

    @property
    def least(self) -> tuple[int, int]:
        """A character for two cells, one above the other."""
        return self.columns, -(-self.rows // 2)

    def scale(self, room: Room) -> int:
        """Return the width of a cell, in columns; 0 if there is no room for all cells."""
        return self._scale(self._beside(room)) or self._scale(room)

    def draw(self, cells: Cells, past: Sequence[np.ndarray], room: Room) -> tuple[list[Row], str]:
        """Return all cells in their places as rows, and words on the part that is shown."""
        drawn, part = self._drawn(cells, room)
        if self.islands is None or not self._scale(self._beside(room)):
            return drawn, part
        return bracketed(drawn, self.islands, self.columns, self.scale(room)), part

    def _beside(self, room: Room) -> Room:
        """Return the room that the names of islands leave for cells."""
        return (
            room if self.islands is None else room._replace(width=room.width - edge(self.islands))
        )

    def _scale(self, room: Room) -> int:
        """Return the width of a cell without names of islands; 0 if not all cells fit."""
        fitting = min(room.width // self.columns, 2 * room.height // self.rows, 2 * WIDEST)
        return max(fitting, 0)

    def _drawn(self, cells: Cells, room: Room) -> tuple[list[Row], str]:
        scale = max(self.scale(room), 1)
        high, across = (
            min(self.rows, 2 * room.height // scale),
            min(self.columns, room.width // scale),
        )
        index = np.arange(high)[:, None] * self.columns + np.arange(across)
        drawn = field(cells.take(index.ravel()), across, scale)
        if high * across == self.rows * self.columns:
            return drawn, ""
        return drawn, f"shown: {high:,} x {across:,} of {self.rows:,} x {self.columns:,} cells"


def part_of(shown: int, count: int, what: str = "cells") -> str:
    """Return words that say which part is shown; "" if all is shown."""
    return "" if shown == count else f"shown: the first {shown:,} of {count:,} {what}"
