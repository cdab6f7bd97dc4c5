"""Pictures of a world's cells: a torus as a square grid, a ring as a circle with its past inside."""

from typing import Protocol

import numpy as np

from primordia.film.colours import GROUND
from primordia.law.placement import Placement

SIDE = 480
"""pixels of a picture, in both directions"""
PAPER = np.array([13, 15, 20], np.uint8)
NOW, INNER = 0.06, 0.3
"""As shares of a ring's radius: the width of the rim that shows the present, and the radius of the
hole."""


class Shape(Protocol):
    """The form in which a world is drawn."""

    cells: np.ndarray
    """numbers of the cells that are drawn, int64 (N,)"""

    def draw(self, colours: np.ndarray) -> np.ndarray:
        """Return the next picture, uint8 (SIDE, SIDE, 3), for the colours of the cells, uint8 (N, 3)."""


def shape(placement: Placement, cells: int) -> Shape:
    """Return the form of a world of this many cells. In a well-mixed world, places have no meaning."""
    rows, columns = placement.shape(cells)
    if rows > 1:
        return Grid(rows, columns)
    if placement.topology == "ring":
        return Ring(cells)
    columns = int(np.ceil(np.sqrt(cells)))
    return Grid(-(-cells // columns), columns, cells)


class Grid:
    """Rows and columns of cells; if there are more than SIDE, only every n-th is drawn."""

    def __init__(self, rows: int, columns: int, count: int | None = None) -> None:
        """Take rows and columns, and the number of cells if they do not fill the last row."""
        step = -(-max(rows, columns) // SIDE)
        numbers = np.arange(rows)[::step, None] * columns + np.arange(columns)[::step]
        self._shape = numbers.shape
        self._zoom = SIDE // max(self._shape)
        self._real = numbers.ravel() < (count or rows * columns)
        self.cells = np.where(self._real, numbers.ravel(), 0)

    def draw(self, colours: np.ndarray) -> np.ndarray:
        """Return the picture; see `Shape`."""
        cells = np.where(self._real[:, None], colours, PAPER).reshape(*self._shape, 3)
        large = cells.repeat(self._zoom, axis=0).repeat(self._zoom, axis=1)
        if self._zoom > 3:
            large[:: self._zoom] = large[:, :: self._zoom] = PAPER
        picture = np.broadcast_to(PAPER, (SIDE, SIDE, 3)).copy()
        top, left = ((SIDE - length) // 2 for length in large.shape[:2])
        picture[top : top + large.shape[0], left : left + large.shape[1]] = large
        return picture


class Ring:
    """A ring of cells. The present is outside; the moments before it are rings within."""

    MOST = 1024
    """largest number of cells that are drawn; if there are more, every second, third, ... is drawn"""

    def __init__(self, count: int) -> None:
        """Take the number of cells."""
        self.cells = np.arange(0, count, -(-count // self.MOST))
        y, x = (np.mgrid[:SIDE, :SIDE] + 0.5) / SIDE * 2 - 1
        radius, turn = np.hypot(x, y), np.arctan2(x, -y) / (2 * np.pi) % 1
        self._inside = (radius < 1) & (radius > INNER)
        past = np.maximum(1 - NOW - radius, 0) * SIDE / 2
        self._moment = past[self._inside].astype(np.int64)
        self._cell = (turn[self._inside] * len(self.cells)).astype(np.int64)
        kept = int(self._moment.max()) + 1
        self._seen = np.broadcast_to(GROUND.astype(np.uint8), (kept, len(self.cells), 3)).copy()
        self._latest = 0

    def draw(self, colours: np.ndarray) -> np.ndarray:
        """Return the picture; see `Shape`."""
        self._latest = (self._latest - 1) % len(self._seen)
        self._seen[self._latest] = colours
        picture = np.broadcast_to(PAPER, (SIDE, SIDE, 3)).copy()
        place = (self._latest + self._moment) % len(self._seen)
        picture[self._inside] = self._seen[place, self._cell]
        return picture
