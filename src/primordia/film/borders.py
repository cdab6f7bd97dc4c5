"""Borders and names of islands in the pictures of a world."""

import numpy as np
from PIL import Image, ImageDraw

from primordia.habitats.framed import font
from primordia.settings.islands import Islands

STRIP = 20
"""pixels beside a world for the names of islands"""
LETTERS, COLOUR = 13, (200, 198, 192)
WIDTH = 4
"""pixels, the largest width of a border"""
GAP = 4
"""pixels between a world and the names to its left"""


def between(island: np.ndarray, width: int) -> np.ndarray:
    """Return whether each pixel lies at a border, from its island's number; bool (rows, columns)."""
    found = np.zeros(island.shape, bool)
    for near in range(1, width // 2 + 1):
        down, across = island[near:] != island[:-near], island[:, near:] != island[:, :-near]
        found[near:] |= down
        found[:-near] |= down
        found[:, near:] |= across
        found[:, :-near] |= across
    return found


def rays(x: np.ndarray, y: np.ndarray, islands: Islands) -> np.ndarray:
    """Return whether each point lies on a border of islands around the middle, bool.

    Args:
        x: pixels to the right of the middle.
        y: pixels below the middle.
        islands: the islands, clockwise from the top.
    """
    found = np.zeros(x.shape, bool)
    for share in np.array(islands.bounds[:-1]) / islands.bounds[-1]:
        across, down = np.sin(2 * np.pi * share), -np.cos(2 * np.pi * share)
        ahead = x * across + y * down > 0
        found |= ahead & (np.abs(x * down - y * across) < WIDTH / 2)
    return found


def name_bands(picture: np.ndarray, left: int, bands: list[tuple[str, int, int]]) -> None:
    """Write names to the left of a world, or upwards if there is no room for the longest one.

    A name that has no room even so is left out.

    Args:
        picture: uint8 (rows, columns, 3).
        left: the first column of the world.
        bands: each island's name, and its first and last pixel from the top.
    """
    words = [_words(name) for name, _, _ in bands]
    upwards = max((each.width for each in words), default=0) > left - 2 * GAP
    for each, (_, top, bottom) in zip(words, bands, strict=True):
        drawn = each.rotate(90, expand=True) if upwards else each
        x = left - (STRIP / 2 if upwards else GAP + drawn.width / 2)
        if drawn.height <= bottom - top:
            _put(picture, drawn, x, (top + bottom) / 2)


def name_sectors(picture: np.ndarray, radius: float, islands: Islands) -> None:
    """Write the names of islands around the middle of a picture, clockwise from the top.

    Args:
        picture: uint8 (rows, columns, 3).
        radius: pixels from the middle to the middle of the names.
        islands: the islands.
    """
    size = len(picture) / 2
    for name, cells in zip(islands.names, islands.cells, strict=True):
        share = (cells.start + cells.stop) / 2 / islands.bounds[-1]
        drawn = _words(name)
        if drawn.width > 2 * np.pi * radius * len(cells) / islands.bounds[-1]:
            continue
        upright = 180 if 0.25 < share < 0.75 else 0  # below the middle, words would be upside down
        turned = drawn.rotate(upright - 360 * share, Image.Resampling.BICUBIC, expand=True)
        angle = 2 * np.pi * share
        _put(picture, turned, size + radius * np.sin(angle), size - radius * np.cos(angle))


def _words(text: str) -> Image.Image:
    """Return words as a picture of their light, from 0 to 255."""
    letters = font(LETTERS)
    left, top, right, bottom = letters.getbbox(text)
    words = Image.new("L", (int(right - left) + 2, int(bottom - top) + 2))
    ImageDraw.Draw(words).text((1 - left, 1 - top), text, 255, letters)
    return words


def _put(picture: np.ndarray, words: Image.Image, x: float, y: float) -> None:
    """Write words with their middle at a pixel; what lies outside of the picture is cut."""
    whole = Image.fromarray(picture)
    corner = round(x - words.width / 2), round(y - words.height / 2)
    whole.paste(COLOUR, corner, words)
    picture[:] = np.asarray(whole)
