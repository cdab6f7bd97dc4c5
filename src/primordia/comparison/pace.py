"""The pace of dying and the food gathered over time, in windows of a world's time."""

from dataclasses import dataclass

import numpy as np

from primordia.comparison.measured import Measured
from primordia.history import series
from primordia.history.foraging import harvests
from primordia.runs.lives import Lives
from primordia.runs.records import Records

WINDOWS, LATE = 12, 3
"""Number of windows of a world's time, and number of the last windows that are called late."""


@dataclass(frozen=True)
class Pace:
    """Ticks lived and deaths of each of W worlds, in windows of equal length."""

    edges: np.ndarray
    """ticks at which the windows begin and end, float64 (WINDOWS + 1,)"""
    lived: np.ndarray
    """organism-ticks, float64 (W, WINDOWS)"""
    deaths: np.ndarray
    """int64 (W, WINDOWS)"""

    @property
    def curve(self) -> np.ndarray:
        """Ticks lived for each death, float64 (W, WINDOWS); a lower bound in windows without deaths."""
        return self.lived / np.maximum(self.deaths, 1)

    @property
    def late(self) -> Measured:
        """Ticks lived for each death in the last quarter of the time."""
        lived, deaths = (each[:, -LATE:].sum(axis=1) for each in (self.lived, self.deaths))
        return Measured(lived / np.maximum(deaths, 1), deaths > 0)


def pace(worlds: list[Lives], begin: int, end: int) -> Pace:
    """Return the pace of dying in each world; all must be on record between ticks `begin` and `end`."""
    edges = np.linspace(begin, end, WINDOWS + 1)
    lived = [series.exposure(world.seen, world.ended, edges) for world in worlds]
    deaths = [
        np.diff(series.count_until(np.sort(world.ended[world.died]), edges)) for world in worlds
    ]
    return Pace(edges, np.array(lived), np.array(deaths))


@dataclass(frozen=True)
class Gathering:
    """Mean food of an organism in a span of time, for each of W worlds."""

    curve: np.ndarray
    """food in each window, float64 (W, WINDOWS); NaN where no organism lived, all NaN without food"""
    late: Measured
    """food in the last quarter of the time; known if any food was gathered"""


def gathering(run: Records, worlds: int, begin: int, end: int, span: float) -> Gathering:
    """Return the food that organisms gather in a `span` of ticks, in each world of a run.

    All worlds must be on record between the ticks `begin` and `end`. The metrics are not read if no
    world gathered any food.
    """
    if not run.count("world.worlds.food").any():
        unknown = Measured(np.zeros(worlds), np.zeros(worlds, bool))
        return Gathering(np.full((worlds, WINDOWS), np.nan), unknown)
    edges = np.linspace(begin, end, WINDOWS + 1)
    totals = harvests(run, worlds)
    curve = span * np.array([harvest.between(edges) for harvest in totals])
    late = span * np.array([harvest.between(edges[[-1 - LATE, -1]])[0] for harvest in totals])
    any_food = bool(np.nan_to_num(curve).any())
    return Gathering(curve, Measured(np.nan_to_num(late), np.full(worlds, any_food)))
