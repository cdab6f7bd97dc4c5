"""The colours of a world's cells, moment by moment.

The hue shows the line of descent, by the rule of `phylogeny.clades`. Cells are lighter with age, flash at
a birth, and fade after a death.
"""

from collections.abc import Iterator

import numpy as np

from primordia.figures.spacetime import EMPTY, line_codes, occupants
from primordia.live.paint import HUES, colour
from primordia.phylogeny.clades import clades_of
from primordia.runs.lives import Lives

GROUND = np.array([22, 25, 33], np.float32)
"""Red, green and blue of an empty cell."""
DARKEST = 0.5
"""Light of an organism at birth; it grows with age, up to 1."""
FLASH = 0.75
"""Share of white in a cell in which an organism was born since the moment before."""
FADING = 0.8
"""After a death, a cell keeps this share of its light from one moment to the next."""
MOST = 2**22
"""Largest number of cells x moments that are computed together; their lives are sorted once."""
PALETTE = np.array([colour(hue) for hue in range(HUES)], np.float32)


def colours(lives: Lives, cells: np.ndarray, ticks: np.ndarray, full: int) -> Iterator[np.ndarray]:
    """Yield the colours of cells after each tick, uint8 (N, 3).

    Args:
        lives: the lives of one world.
        cells: numbers of cells, int64 (N,).
        ticks: the moments in ascending order, int64 (F,).
        full: the age in ticks at which a cell is lightest.
    """
    clades, before = clades_of(lives), int(ticks[0])
    embers = np.broadcast_to(GROUND, (len(cells), 3)).copy()
    together = max(MOST // len(cells), 1)
    for at in range(0, len(ticks), together):
        block = ticks[at : at + together]
        rows = occupants(lives, cells, block)
        codes = line_codes(lives, clades, rows, block)
        for tick, row, code in zip(block.tolist(), rows, codes, strict=True):
            alive = row != EMPTY
            born = np.where(alive, lives.born[row], before)  # no birth in an empty cell
            lit = _lit(born, code, before, tick, full)
            embers = GROUND + (embers - GROUND) * FADING
            embers[alive] = lit[alive]
            yield embers.astype(np.uint8)
            before = tick


def _lit(born: np.ndarray, code: np.ndarray, before: int, tick: int, full: int) -> np.ndarray:
    """Return the colours of organisms, float32 (N, 3)."""
    age = np.clip(np.log1p(np.maximum(tick - born, 0)) / np.log1p(full), 0, 1)
    colour = PALETTE[code % HUES] * (DARKEST + (1 - DARKEST) * age)[:, None]
    new = born > before
    # Where most cells are new at every moment, flashes would hide the lines.
    flash = FLASH * max(1 - 4 * new.mean(), 0)
    colour[new] += flash * (255 - colour[new])
    return colour.astype(np.float32)
