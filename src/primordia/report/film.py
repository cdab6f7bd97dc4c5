"""A world on a torus as a film: the lines and ages in all its cells, after some of its births."""

from typing import Any

import numpy as np

from primordia.config import Config
from primordia.figures.spacetime import EMPTY, line_codes, occupants
from primordia.history import series
from primordia.report.ground import Ground
from primordia.report.packed import packed

PICTURES = 300
"""Largest number of pictures."""
BYTES = 4_000_000
"""Largest number of cells of all pictures together."""
SHADES = 8
"""Steps of age, on a logarithmic scale."""
INK_BITS = 5


def film(ground: Ground, config: Config) -> dict[str, Any] | None:
    """Return the film of a world for `film.js`; None if the world is not on a torus, or too large.

    Returns:
        `cells`: a byte for each picture and cell: 0 for an empty cell, else ink + 1 in the lower 5
        bits and the shade of the age in the upper 3. `places`, `ticks` and `alive` have a value for
        each picture.
    """
    rows, columns = config.placement.shape(config.cells)
    count = min(PICTURES, BYTES // ground.share // config.cells, len(ground.lives))
    if rows == 1 or count < 2:
        return None
    places = series.places(len(ground.lives), count)
    ticks = ground.lives.born[places]
    pictures = _pictures(ground, ticks)
    return {
        "rows": rows,
        "columns": columns,
        "places": places.tolist(),
        "ticks": ticks.tolist(),
        "alive": (pictures > 0).sum(axis=1).tolist(),
        "cells": packed(pictures),
    }


def _pictures(ground: Ground, ticks: np.ndarray) -> np.ndarray:
    """Return colour and shade of each cell after each tick, as one byte, uint8 (T, N)."""
    lives, bytes_ = ground.lives, np.zeros((len(ticks), ground.cells), np.uint8)
    rows = occupants(lives, np.arange(ground.cells), ticks)
    there = rows != EMPTY
    inks = ground.inks(line_codes(lives, ground.clades, rows, ticks)[there])
    age = np.log1p(np.maximum(ticks[:, None] - lives.born[rows], 0)[there])
    oldest = np.log1p(max(float(lives.lifespan.max()), 1.0))
    shade = np.minimum(SHADES * age / oldest, SHADES - 1).astype(np.int64)
    bytes_[there] = inks + 1 | shade << INK_BITS
    return bytes_
