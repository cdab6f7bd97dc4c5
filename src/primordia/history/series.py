"""Curves over time, exact at every tick, from births and deaths alone."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from primordia.runs.lives import Lives

POINTS = 1000
"""Points of a curve: about as many as a page has room for."""
MIN_EVENTS = 3
"""Smallest number of events that a rate is computed from."""


def moments(last: int) -> np.ndarray:
    """Return ticks from 1 to `last`, evenly spaced on a logarithmic axis; int64, ascending."""
    return np.unique(np.geomspace(1, max(last, 1), POINTS).round().astype(np.int64))


def curve_by_world(
    curve: Callable[[Lives, np.ndarray], np.ndarray], worlds: list[Lives], ticks: np.ndarray
) -> np.ndarray:
    """Return the curve of each world, float64 (W, T); NaN before its fork and after its last tick."""

    def on_record(world: Lives) -> np.ndarray:
        return (world.seen.min() <= ticks) & (ticks <= world.ended.max())

    return np.array([np.where(on_record(world), curve(world, ticks), np.nan) for world in worlds])


def population(lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """Return the number of living in one world after each tick, int64."""
    deaths = np.sort(lives.ended[lives.died])
    return count_until(lives.born, ticks) - count_until(deaths, ticks)


def mean_age(lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """Return the mean age of the living of one world after each tick, float64; NaN in an empty world."""
    dead = np.flatnonzero(lives.died)
    dead = dead[np.argsort(lives.ended[dead], kind="stable")]
    births, deaths = count_until(lives.born, ticks), count_until(lives.ended[dead], ticks)
    alive = births - deaths
    born = _sum_first(lives.born, births) - _sum_first(lives.born[dead], deaths)
    return np.where(alive > 0, (ticks * alive - born) / np.maximum(alive, 1), np.nan)


def spread(values: np.ndarray) -> np.ndarray:
    """Return the quartiles of worlds (W, X) if at least half of them have a value, else NaN: (3, X)."""
    enough = np.isfinite(values).mean(axis=0) >= 0.5
    quartiles = np.full((3, values.shape[1]), np.nan)
    if enough.any():
        quartiles[:, enough] = np.nanpercentile(values[:, enough], [25, 50, 75], axis=0)
    return quartiles


def mean_of_known(values: np.ndarray, axis: int) -> np.ndarray:
    """Return the mean along an axis of the values that are known, float64; NaN if there are none."""
    return np.ma.masked_invalid(values).mean(axis=axis).filled(np.nan)


def plain(values: ArrayLike) -> Any:
    """Return numbers for JSON, an array as lists; None stands for a number that is not finite."""
    numbers = np.asarray(values)
    return np.where(np.isfinite(numbers), numbers.astype(object), np.array(None)).tolist()


def positive(values: np.ndarray) -> np.ndarray:
    """Return the values, with NaN in place of values that a logarithmic axis cannot show."""
    return np.where(values > 0, values, np.nan)


def exposure(start: np.ndarray, stop: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return how many ticks all lives, from `start` to `stop`, spend in each bin of `edges`, int64."""
    return np.diff(_lived_by(start, edges) - _lived_by(stop, edges))


def bins(last: int) -> np.ndarray:
    """Return bin edges 0, 1, 2, 3, 4, 6, 10, ..., `last`: five for each factor of ten; int64."""
    edges = 10 ** (np.arange(5 * np.log10(max(last, 1))) / 5)
    return np.unique(np.concatenate([[0], edges.round(), [max(last, 1)]]).astype(np.int64))


def per_tick(at: np.ndarray, lived: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return the events in each bin divided by the ticks `lived` in it; NaN below MIN_EVENTS events."""
    count = np.diff(count_until(np.sort(at), edges))
    return np.where(count >= MIN_EVENTS, count / np.maximum(lived, 1), np.nan)


def middle(edges: np.ndarray) -> np.ndarray:
    """Return the middle of the ticks in each bin on a logarithmic axis, float64."""
    return np.sqrt((edges[:-1] + 1.0) * edges[1:])  # as integers they could overflow


def count_until(rising: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Return how many of the sorted values `rising` are at most as large as each tick, int64."""
    return np.searchsorted(rising, ticks, side="right")


def _lived_by(start: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return the sum of the ticks from each earlier `start` to an edge, for each of `edges`."""
    start = np.sort(start)
    past = count_until(start, edges)
    return past * edges - _sum_first(start, past)


def _sum_first(values: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Return the sum of the first `count` values for each of `counts`."""
    return np.append(0, np.cumsum(values))[counts]


def places(count: int, most: int) -> np.ndarray:
    """Return at most `most` of `count` places, evenly spaced from the first to the last, int64."""
    return np.linspace(0, count - 1, min(most, count)).astype(np.int64)


def spaced(rows: np.ndarray, most: int) -> np.ndarray:
    """Return at most `most` of the rows, each in the middle of one of equal parts, int64."""
    parts = min(most, len(rows))
    return rows[((np.arange(parts) + 0.5) * len(rows) / parts).astype(int)]
