"""Food that organisms gather over time, in the same windows as `pace`."""

from dataclasses import dataclass

import numpy as np

from primordia.comparison.measured import Measured
from primordia.comparison.pace import LATE, WINDOWS
from primordia.history.foraging import harvests
from primordia.runs.records import Records


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
        return Gathering(np.full((worlds, WINDOWS), np.nan), _known(np.zeros(worlds), False))
    edges = np.linspace(begin, end, WINDOWS + 1)
    totals = harvests(run, worlds)
    curve = span * np.array([harvest.between(edges) for harvest in totals])
    late = span * np.array([harvest.between(edges[[-1 - LATE, -1]])[0] for harvest in totals])
    any_food = bool(np.nan_to_num(curve).any())
    return Gathering(curve, _known(np.nan_to_num(late), any_food))


def _known(late: np.ndarray, known: bool) -> Measured:
    return Measured(late, np.full(len(late), known))
