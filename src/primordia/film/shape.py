"""Pictures of a world's cells: a torus as a square grid, a ring as a circle with its past inside.

Both have `cells`, the numbers of the cells that are drawn, int64 (N,), and `draw`. It takes the colours
of these cells, uint8 (N, 3), and returns the next picture, uint8 (SIDE, SIDE, 3).
"""

import numpy as np

from primordia.film import borders
from primordia.film.borders import STRIP, WIDTH
from primordia.film.colours import GROUND
from primordia.law.placement import Placement
from primordia.settings.islands import Islands

SIDE = 480
"""pixels of a picture, in both directions"""
PAPER = np.array([13, 15, 20], np.uint8)
NOW, INNER = 0.06, 0.3
"""As shares of a ring's radius: the width of the rim that shows the present, and the radius of the
hole."""


def shape(placement: Placement, cells: int, islands: Islands | None = None) -> "Grid | Ring":
    """Return the form of a world of this many cells. In a well-mixed world, places have no meaning.

    `islands` are those of the world; if there are several, their borders and names are drawn.
    """
    several = islands if islands is not None and islands.count > 1 else None
    rows, columns = placement.shape(cells)
    if rows > 1:
        return Grid(rows, columns, islands=several)
    if placement.topology == "ring":
        return Ring(cells, several)
    columns = _columns(cells, several)
    return Grid(-(-cells // columns), columns, cells, several)


def _columns(cells: int, islands: Islands | None) -> int:
    """Return the columns of a well-mixed world: those of a square, or fewer, if islands fill whole rows
    then."""
    square = int(np.ceil(np.sqrt(cells)))
    if islands is None:
        return square
    lengths = np.diff(islands.bounds)
    fitting = max(width for width in range(1, square + 1) if not (lengths % width).any())
    return fitting if 3 * fitting >= square else square


class Grid:
    """Rows and columns of cells; if there are more than there is room for, only every n-th is drawn."""

    def __init__(
        self, rows: int, columns: int, count: int | None = None, islands: Islands | None = None
    ) -> None:
        """Take rows and columns, the number of cells if they do not fill the last row, and islands."""
        strip = 0 if islands is None else STRIP
        room = SIDE - strip
        step = -(-max(rows, columns) // room)
        numbers = np.arange(rows)[::step, None] * columns + np.arange(columns)[::step]
        self._shape = numbers.shape
        self._zoom = room // max(self._shape)
        self._real = numbers.ravel() < (count or rows * columns)
        self.cells = np.where(self._real, numbers.ravel(), 0)
        high, wide = (length * self._zoom for length in self._shape)
        self._top, self._left = (SIDE - high) // 2, strip + (room - wide) // 2
        self._paper = np.broadcast_to(PAPER, (SIDE, SIDE, 3)).copy()
        self._borders: np.ndarray | None = None
        if islands is not None:
            self._mark(islands, np.minimum(numbers, islands.bounds[-1] - 1))

    def _mark(self, islands: Islands, numbers: np.ndarray) -> None:
        """Prepare the borders of islands, and write their names beside rows that are mostly theirs."""
        island = self._large(islands.of_cells(numbers))
        self._borders = borders.between(island, min(WIDTH, self._zoom // 2))
        bands = []
        for number, name in enumerate(islands.names):
            (own,) = np.nonzero((island == number).mean(axis=1) > 0.5)
            if own.size:
                bands.append((name, self._top + int(own[0]), self._top + int(own[-1]) + 1))
        borders.name_bands(self._paper, self._left, bands)

    def _large(self, cells: np.ndarray) -> np.ndarray:
        return cells.repeat(self._zoom, axis=0).repeat(self._zoom, axis=1)

    def draw(self, colours: np.ndarray) -> np.ndarray:
        """Return the next picture."""
        cells = np.where(self._real[:, None], colours, PAPER).reshape(*self._shape, 3)
        large = self._large(cells)
        if self._zoom > 3:
            large[:: self._zoom] = large[:, :: self._zoom] = PAPER
        if self._borders is not None:
            large[self._borders] = PAPER
        picture, (top, left) = self._paper.copy(), (self._top, self._left)
        picture[top : top + large.shape[0], left : left + large.shape[1]] = large
        return picture


class Ring:
    """A ring of cells. The present is outside; the moments before it are rings within."""

    MOST = 1024
    """largest number of cells that are drawn; if there are more, every second, third, ... is drawn"""

    def __init__(self, count: int, islands: Islands | None = None) -> None:
        """Take the number of cells, and islands."""
        self.cells = np.arange(0, count, -(-count // self.MOST))
        y, x = (np.mgrid[:SIDE, :SIDE] + 0.5) / SIDE * 2 - 1
        outer = 1 if islands is None else 1 - 2 * STRIP / SIDE
        radius, turn = np.hypot(x, y) / outer, np.arctan2(x, -y) / (2 * np.pi) % 1
        self._inside = (radius < 1) & (radius > INNER)
        self._paper = np.broadcast_to(PAPER, (SIDE, SIDE, 3)).copy()
        if islands is not None:
            self._inside &= ~borders.rays(x * SIDE / 2, y * SIDE / 2, islands)
            borders.name_sectors(self._paper, SIDE / 2 - STRIP / 2, islands)
        past = np.maximum(1 - NOW - radius, 0) * SIDE / 2
        self._moment = past[self._inside].astype(np.int64)
        self._cell = (turn[self._inside] * len(self.cells)).astype(np.int64)
        kept = int(self._moment.max()) + 1
        self._seen = np.broadcast_to(GROUND.astype(np.uint8), (kept, len(self.cells), 3)).copy()
        self._latest = 0

    def draw(self, colours: np.ndarray) -> np.ndarray:
        """Return the next picture."""
        self._latest = (self._latest - 1) % len(self._seen)
        self._seen[self._latest] = colours
        picture = self._paper.copy()
        place = (self._latest + self._moment) % len(self._seen)
        picture[self._inside] = self._seen[place, self._cell]
        return picture
