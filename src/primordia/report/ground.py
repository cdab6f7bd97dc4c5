"""The space-time picture of one world as data: the organism in each cell between successive births.

Time runs in births, as in `figures.spacetime`: place p shows the cells after the tick of the p-th birth.
A world with few births is given completely. For a larger world, the cells are read only after some
births, and only the organisms found then, and the living, are given.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from primordia.figures.spacetime import (
    COLUMNS,
    EMPTY,
    INKS,
    line_codes,
    line_inks,
    occupants,
)
from primordia.history import series
from primordia.phylogeny.clades import Clades, clades_of, crowd_size
from primordia.report.packed import packed
from primordia.runs.lives import Lives
from primordia.settings.islands import Islands

WHOLE = 100_000
"""A world with at most this many births has all its organisms in the page."""
SEEN = 400_000
"""Largest number of cells that are read in a larger world, over all moments."""
MARKS = 12
"""Largest number of marks; a mark shows a moment at which all lines began again."""


@dataclass(frozen=True)
class Ground:
    """The lives of one world, and their segments in a picture."""

    lives: Lives
    cells: int
    """cells of the world"""
    share: int = 1
    """number of worlds in the page; each world gets an equal part of the page's size"""
    islands: Islands | None = None
    """the islands of the world; None: a plain world"""

    @cached_property
    def clades(self) -> Clades:
        """The lines of descent."""
        return clades_of(self.lives)

    @cached_property
    def shown(self) -> np.ndarray:
        """The cells that are shown, int64 (N,): all, or evenly spaced ones."""
        return np.arange(0, self.cells, -(-self.cells // COLUMNS))

    @cached_property
    def moments(self) -> np.ndarray:
        """The times at which the cells are read, counted in births, int64 (T,), ascending."""
        births = len(self.lives)
        if births <= WHOLE // self.share:
            return np.arange(births)
        count = max(SEEN // self.share // len(self.shown), 2)
        return series.places(births, count)

    @property
    def whole(self) -> bool:
        """Whether all organisms are given."""
        return len(self.moments) == len(self.lives)

    @cached_property
    def rows(self) -> np.ndarray:
        """The rows of the organisms that are given, int64 (R,), ascending."""
        if self.whole:
            return np.arange(len(self.lives))
        seen = occupants(self.lives, self.shown, self.lives.born[self.moments])
        living = np.flatnonzero(~self.lives.died)
        rows = np.unique(np.concatenate([seen.ravel(), living[: SEEN // self.share]]))
        return rows[rows != EMPTY]

    @cached_property
    def segments(self) -> dict[str, np.ndarray]:
        """The lives in the shown cells as S segments, sorted by cell and time; each array is (S,).
        A life is split at each moment at which new lines begin.

        `row`: row of the organism; `start`, `stop`: the times, in births, at which the segment
        begins and ends; `code`: its line, see `line_codes`.
        """
        lives, births = self.lives, len(self.lives)
        rows = self.rows[np.isin(lives.cell[self.rows], self.shown)]
        first = np.searchsorted(lives.born, lives.born[rows])
        last = np.where(lives.died[rows], np.searchsorted(lives.born, lives.ended[rows]), births)
        borders = np.searchsorted(lives.born, self.clades.renewals)
        begun, ended = (
            np.searchsorted(borders, each, side="right")
            for each in (first, np.maximum(last - 1, 0))
        )
        count = ended - begun + 1
        which = np.repeat(np.arange(len(rows)), count)
        era = begun[which] + np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
        edges = np.concatenate([[0], borders, [births]])
        start, stop = np.maximum(first[which], edges[era]), np.minimum(last[which], edges[era + 1])
        keep = np.flatnonzero(stop > start)
        row, start, stop = rows[which[keep]], start[keep], stop[keep]
        code = line_codes(lives, self.clades, row[:, None], lives.born[start])[:, 0]
        order = np.lexsort((start, lives.cell[row]))
        found = {"row": row, "start": start, "stop": stop, "code": code}
        return {name: values[order] for name, values in found.items()}

    @cached_property
    def _inked(self) -> tuple[np.ndarray, np.ndarray]:
        """The codes of the lines in the picture, ascending, and the ink of each."""
        segments = self.segments
        codes, place = np.unique(segments["code"], return_inverse=True)
        size = np.bincount(place, segments["stop"] - segments["start"], len(codes))
        return codes, line_inks(self.lives, self.clades, codes, size)

    def inks(self, codes: np.ndarray) -> np.ndarray:
        """Return the ink of each line, an index of `figures.spacetime.INKS`, by its code, int64 (n,)."""
        known, inks = self._inked
        place = np.minimum(np.searchsorted(known, codes), len(known) - 1)
        found, other = inks[place], known[place] != codes
        if other.any():  # lines that live only in cells that are not shown
            lines, which, size = np.unique(codes[other], return_inverse=True, return_counts=True)
            found[other] = line_inks(self.lives, self.clades, lines, size)[which]
        return found

    def data(self) -> dict[str, Any]:
        """Return the data for `ground.js`."""
        segments, lives = self.segments, self.lives
        column = np.searchsorted(self.shown, lives.cell[segments["row"]])
        return {
            "births": len(lives),
            "cells": self.cells,
            "shown": len(self.shown),
            "step": int(self.shown[1] - self.shown[0]) if len(self.shown) > 1 else 1,
            "whole": self.whole,
            "moments": packed(self.moments, rising=True),
            "ticks": packed(np.maximum(lives.born[self.moments], 0), rising=True),
            "marks": self._marks(),
            "segments": {
                "column": packed(column, rising=True),
                "organism": packed(np.searchsorted(self.rows, segments["row"])),
                "start": packed(segments["start"]),
                "stop": packed(segments["stop"]),
                "ink": packed(self.inks(segments["code"])),
            },
        }

    def _marks(self) -> list[dict[str, Any]]:
        """Return the first renewals of lines: their times, in births, and why lines began."""
        renewals, takeovers = self.clades.renewals[:MARKS], self.clades.by_takeover[:MARKS]
        places = np.searchsorted(self.lives.born, renewals).tolist()
        crowd = f"{crowd_size(self.lives)} alive: each begins a line"
        return [
            {"place": place, "tick": tick, "why": "one line has taken over" if taken else crowd}
            for place, tick, taken in zip(
                places, renewals.tolist(), takeovers.tolist(), strict=True
            )
        ]


def palette() -> list[list[int]]:
    """Return all inks as red, green and blue from 0 to 255."""
    return [[round(255 * part) for part in ink] for ink in INKS.tolist()]
