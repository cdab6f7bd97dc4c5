"""What organisms gather as time goes on, in the windows that pace has too."""

from dataclasses import dataclass

import numpy as np

from primordia.comparison.contrast import Figures
from primordia.comparison.pace import LATE, WINDOWS
from primordia.history.foraging import harvests
from primordia.runs.archive import Archive


@dataclass(frozen=True)
class Gathering:
    """Food that an organism gathered in a span of time, world by world."""

    curve: np.ndarray
    """float64 (W, WINDOWS); NaN where nobody lived"""
    late: Figures
    """in the last quarter of the time; known if there was any food at all"""


def gathering(run: Archive, worlds: int, since: int, until: int, span: float) -> Gathering:
    """Of the worlds of a run, between two ticks at which all are on record; a span is so many ticks."""
    edges = np.linspace(since, until, WINDOWS + 1)
    found = harvests(run, worlds)
    curve = span * np.array([harvest.between(edges) for harvest in found])
    late = span * np.array([harvest.between(edges[[-1 - LATE, -1]])[0] for harvest in found])
    any_food = bool(np.nan_to_num(curve).any())
    return Gathering(curve, Figures(np.nan_to_num(late), np.full(worlds, any_food)))
