"""The forms of worlds: a ring as a skyline with its past below, a torus as a picture."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from primordia.law.law import Law
from primordia.live.paint import Cells, Row, field, mosaic, skyline, strip

TALLEST = 4
"""Largest number of rows of a skyline."""
WIDEST = 8
"""Largest number of columns of a cell."""


class Room(NamedTuple):
    """The room for a drawing, in characters, and whether letters take the place of colours."""

    width: int
    height: int
    letters: bool
    """whether letters mark lines of descent: true if the terminal has too few colours"""


class Form(Protocol):
    """The form in which a world of some cells is drawn."""

    @property
    def least(self) -> tuple[int, int]:
        """Smallest numbers of columns and rows of characters in which all cells can be drawn."""

    def scale(self, room: Room) -> int:
        """Return how large a cell can be in a room; 0 if there is no room for all cells."""

    def draw(self, cells: Cells, past: Sequence[np.ndarray], room: Room) -> tuple[list[Row], str]:
        """Draw all cells of a world in a room, and say which part of them is shown if not all are.

        `past` has the shades of the cells at earlier moments, the latest first.
        """

    def age(self, room: Room) -> str:
        """Say how age is shown in a room."""


def form_of(law: Law, letters: bool) -> Form:
    """Return the form of a law's worlds. In a well-mixed world the places have no meaning."""
    rows, columns = law.placement.shape(law.cells)
    return Ring(law.cells) if rows == 1 else Torus(rows, columns, letters)


@dataclass(frozen=True)
class Ring:
    """Cells as a skyline. Many cells make several skylines. A single skyline has its past below it."""

    cells: int

    @property
    def least(self) -> tuple[int, int]:
        """A row of cells."""
        return self.cells, 1

    def scale(self, room: Room) -> int:
        """Return the width of a cell, in columns; see `Form`."""
        return min(room.width // self.cells, WIDEST) if room.height else 0

    def draw(self, cells: Cells, past: Sequence[np.ndarray], room: Room) -> tuple[list[Row], str]:
        """Draw the cells in order; see `Form`."""
        wide = max(self.scale(room), 1)
        letter_rows = 1 if room.letters else 0
        most = max(room.height // (1 + letter_rows), 1)
        count = min(-(-self.cells * wide // (room.width // wide * wide)), most)
        across = min(-(-self.cells // count), room.width // wide)
        shown = min(across * count, self.cells)
        gap = 1 if count > 1 else 0
        tall = min(max(room.height // count - gap - letter_rows, 1), TALLEST)
        with_gaps = count > 1 and count * (tall + letter_rows + 1) - 1 <= room.height
        rows: list[Row] = []
        for at in range(0, shown, across):
            if with_gaps and rows:
                rows.append([])
            part = cells.take(slice(at, min(at + across, shown)))
            if room.letters and room.height == 1:
                rows.append(strip(part, letters=True))
            else:
                rows += skyline(part, wide, tall, room.letters)
        left = room.height - len(rows)
        if count == 1 and not room.letters:
            earlier = [moment[:shown].repeat(wide) for moment in past[: 2 * left]]
            drawn = mosaic(np.stack(earlier)) if earlier else []
            rows += [*drawn, *[[]] * (left - len(drawn))]
        return rows, part_of(shown, self.cells)

    def age(self, room: Room) -> str:
        """Say how age is shown in a room; see `Form`."""
        return "capitals: old" if room.letters and room.height == 1 else "height: age"


@dataclass(frozen=True)
class Torus:
    """Cells as a picture."""

    rows: int
    columns: int
    letters: bool

    @property
    def least(self) -> tuple[int, int]:
        """With letters, a character for each cell; in colours, one for two cells."""
        return self.columns, self.rows if self.letters else -(-self.rows // 2)

    def scale(self, room: Room) -> int:
        """Return the width of a cell, in columns; see `Form`."""
        across, high = room.width // self.columns, room.height // self.rows
        if self.letters:
            return min(across, high, 1)
        return min(across, 2 * room.height // self.rows, 2 * WIDEST)

    def draw(self, cells: Cells, past: Sequence[np.ndarray], room: Room) -> tuple[list[Row], str]:
        """Draw the cells in their places; see `Form`."""
        scale = max(self.scale(room), 1)
        pixels = room.height if self.letters else 2 * room.height
        high, across = min(self.rows, pixels // scale), min(self.columns, room.width // scale)
        index = np.arange(high)[:, None] * self.columns + np.arange(across)
        drawn = field(cells.take(index.ravel()), across, scale, self.letters)
        if high * across == self.rows * self.columns:
            return drawn, ""
        return drawn, f"shown: {high:,} x {across:,} of {self.rows:,} x {self.columns:,} cells"

    def age(self, room: Room) -> str:
        """Say how age is shown in a room; see `Form`."""
        return "capitals: old" if room.letters else "light: age"


def part_of(shown: int, count: int, what: str = "cells") -> str:
    """Return words that say which part is shown; "" if all is shown."""
    return "" if shown == count else f"shown: the first {shown:,} of {count:,} {what}"
