"""Cells as characters: colour shows the line of descent; height or light shows the age."""

import colorsys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import groupby, repeat
from math import log1p

import numpy as np
from rich.color import Color
from rich.segment import Segment
from rich.style import Style

Row = list[Segment]
"""One row of characters in the terminal."""
EMPTY, OUTSIDE = -1, -2
"""Marks of an empty cell and of a place without a cell; they stand in place of the number of a line
of descent."""
HUES = 64
EIGHTHS = " ▁▂▃▄▅▆▇█"
FAINT = Style(color="grey50")
GROUND = (45, 45, 45)
"""Colour of empty cells on a torus: red, green and blue."""


@dataclass(frozen=True)
class Cells:
    """Line of descent and age of n cells, (n,) each."""

    line: np.ndarray
    """int64, or EMPTY"""
    age: np.ndarray
    """float64 on a logarithmic scale, 0 at birth, 1 from a set age on"""

    @classmethod
    def of(cls, line: np.ndarray, ticks: np.ndarray, full: int) -> "Cells":
        """Make cells from ages in ticks, int64; the age `full` and all higher ages become 1."""
        return cls(line, np.minimum(np.log1p(np.maximum(ticks, 0)) / log1p(full), 1.0))

    def take(self, index: slice | np.ndarray) -> "Cells":
        """Return the cells at an index."""
        return Cells(self.line[index], self.age[index])


def skyline(cells: Cells, wide: int, tall: int) -> list[Row]:
    """Draw a bar for each cell; older cells have higher bars. A bar has `wide` x `tall` characters."""
    bar, gap = max(wide - 1, 1), " " if wide > 1 else ""
    living = cells.line != EMPTY
    most = 8 * tall if tall > 1 else 7  # a single row does not touch the row above
    eighths = np.where(living, 1 + np.rint(cells.age * (most - 1)), 0).astype(int)
    styles = [FAINT if line == EMPTY else _style(line % HUES) for line in cells.line.tolist()]
    rows = []
    for below in range(8 * (tall - 1), -1, -8):
        heights = np.clip(eighths - below, 0, 8).tolist()
        glyphs = [EIGHTHS[height] * bar + gap for height in heights]
        if below == 0:
            glyphs = [
                g if live else "·" * bar + gap for g, live in zip(glyphs, living, strict=True)
            ]
        rows.append(_joined(glyphs, styles))
    return rows


def field(cells: Cells, columns: int, scale: int) -> list[Row]:
    """Draw cells, `columns` in a row, as colours, which are lighter with age.

    The width of a cell is `scale` characters, and its height is `scale` / 2 rows.
    """
    return mosaic(np.kron(shades(cells).reshape(-1, columns), np.ones((scale, scale), int)))


def shades(cells: Cells) -> np.ndarray:
    """Return a number for the colour and light of each cell, int64 (n,): 4 x hue + light, or EMPTY."""
    lights = np.minimum((cells.age * 4).astype(np.int64), 3)
    return np.where(cells.line == EMPTY, EMPTY, cells.line % HUES * 4 + lights)


def mosaic(numbers: np.ndarray) -> list[Row]:
    """Draw rows of shades, int64 (rows, columns); each row of characters shows two rows of shades."""
    return _halves(numbers, _shade)


def photograph(pixels: np.ndarray) -> list[Row]:
    """Draw a picture, uint8 (rows, columns, 3), two of its rows in a row of characters."""
    # 4096 colours look the same as all colours, and their styles can be kept.
    red, green, blue = np.moveaxis(pixels.astype(np.int64) >> 4, -1, 0)
    return _halves(red << 8 | green << 4 | blue, _point)


def _halves(numbers: np.ndarray, tint: Callable[[int], tuple[float, float, float]]) -> list[Row]:
    """Draw numbers as upper and lower halves of characters; `tint` has their red, green and blue."""
    if len(numbers) % 2:
        numbers = np.vstack([numbers, np.full_like(numbers[:1], OUTSIDE)])
    return [
        _joined(["▀"] * len(upper), map(_pair, repeat(tint), upper, lower))
        for upper, lower in zip(numbers[::2].tolist(), numbers[1::2].tolist(), strict=True)
    ]


@lru_cache(2**15)
def _pair(tint: Callable[[int], tuple[float, float, float]], upper: int, lower: int) -> Style:
    """Return the style of two points above each other."""
    below = None if lower == OUTSIDE else Color.from_rgb(*tint(lower))
    return Style(color=Color.from_rgb(*tint(upper)), bgcolor=below)


def levels(values: np.ndarray) -> str:
    """Return a bar for each number: -1 gives the lowest bar, 1 the highest."""
    heights = np.rint((np.clip(np.nan_to_num(values), -1, 1) + 1) * 3.5).astype(int) + 1
    return "".join(EIGHTHS[height] for height in heights.tolist())


def _joined(glyphs: list[str], styles: Iterable[Style]) -> Row:
    """Join characters of one style into one segment, since rich and terminals are slow with many
    segments."""
    runs = groupby(zip(glyphs, styles, strict=True), key=lambda pair: id(pair[1]))
    parts = (list(run) for _, run in runs)
    return [Segment("".join(glyph for glyph, _ in part), part[0][1]) for part in parts]


@cache
def colour(hue: int) -> tuple[int, int, int]:
    """Return the colour of a hue number; each hue is a golden-ratio step from the last."""
    light = 0.6 if hue % 2 else 0.7
    red, green, blue = colorsys.hls_to_rgb(hue * 0.61803398875 % 1.0, light, 0.66)
    return round(255 * red), round(255 * green), round(255 * blue)


@cache
def _style(hue: int) -> Style:
    return Style(color=Color.from_rgb(*colour(hue)))


def _point(number: int) -> tuple[float, float, float]:
    """Return the colour of a point of a picture, of 4 bits for each of red, green and blue."""
    return (number >> 8) * 17, (number >> 4 & 15) * 17, (number & 15) * 17


def _shade(code: int) -> tuple[float, float, float]:
    if code == EMPTY:
        return GROUND
    light = (0.4, 0.6, 0.8, 1.0)[code % 4]
    red, green, blue = colour(code // 4)
    return red * light, green * light, blue * light
