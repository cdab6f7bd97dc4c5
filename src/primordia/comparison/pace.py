"""How fast organisms die as time goes on: ticks lived for each death, in windows of a world's time."""

from dataclasses import dataclass

import numpy as np

from primordia.comparison.contrast import Figures
from primordia.history import series
from primordia.runs.lives import Lives

WINDOWS, LATE = 12, 3
"""Windows that time is cut into, and how many of the last are called late."""


@dataclass(frozen=True)
class Pace:
    """Ticks lived and deaths, world by world, in windows of equal length."""

    edges: np.ndarray
    """ticks of the world, float64 (WINDOWS + 1,)"""
    lived: np.ndarray
    """organism-ticks, float64 (W, WINDOWS)"""
    deaths: np.ndarray
    """int64 (W, WINDOWS)"""

    @property
    def curve(self) -> np.ndarray:
        """Ticks lived for each death, float64 (W, WINDOWS); where nobody died, at least so many."""
        return self.lived / np.maximum(self.deaths, 1)

    @property
    def late(self) -> Figures:
        """The same for the last quarter of the time."""
        lived, deaths = (each[:, -LATE:].sum(axis=1) for each in (self.lived, self.deaths))
        return Figures(lived / np.maximum(deaths, 1), deaths > 0)


def pace(worlds: list[Lives], since: int, until: int) -> Pace:
    """Of the lives of each world, between two ticks at which all worlds are on record."""
    edges = np.linspace(since, until, WINDOWS + 1)
    lived = [series.exposure(world.seen, world.ended, edges) for world in worlds]
    deaths = [
        np.diff(series.count_until(np.sort(world.ended[world.died]), edges)) for world in worlds
    ]
    return Pace(edges, np.array(lived), np.array(deaths))
