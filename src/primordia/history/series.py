"""Numbers over time, exact at every tick, from births and deaths alone."""

from collections.abc import Callable

import numpy as np

from primordia.runs.lives import Lives

POINTS = 1000
"""Of a curve: about as many as a page has room for."""
FEW = 3
"""Fewer events than this make no rate."""


def moments(until: int) -> np.ndarray:
    """Ticks from 1 to `until`, evenly spread on a logarithmic axis; int64, rising."""
    return np.unique(np.geomspace(1, max(until, 1), POINTS).round().astype(np.int64))


def of_worlds(
    curve: Callable[[Lives, np.ndarray], np.ndarray], worlds: list[Lives], ticks: np.ndarray
) -> np.ndarray:
    """A curve of each world, float64 (W, T); NaN before a fork, and where no world has come to yet."""

    def on_record(world: Lives) -> np.ndarray:
        return (world.seen.min() <= ticks) & (ticks <= world.ended.max())

    return np.array([np.where(on_record(world), curve(world, ticks), np.nan) for world in worlds])


def population(lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """How many of one world's lives are alive after each tick, int64."""
    deaths = np.sort(lives.ended[lives.died])
    return until(lives.born, ticks) - until(deaths, ticks)


def mean_age(lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """Mean age of the living of one world after each tick, float64; NaN where nobody lives."""
    dead = np.flatnonzero(lives.died)
    dead = dead[np.argsort(lives.ended[dead], kind="stable")]
    births, deaths = until(lives.born, ticks), until(lives.ended[dead], ticks)
    alive = births - deaths
    born = _sum_first(lives.born, births) - _sum_first(lives.born[dead], deaths)
    return np.where(alive > 0, (ticks * alive - born) / np.maximum(alive, 1), np.nan)


def exposure(start: np.ndarray, stop: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Ticks that lives from `start` to `stop` spent between each two of `edges`, int64."""
    return np.diff(_lived_by(start, edges) - _lived_by(stop, edges))


def bins(last: int) -> np.ndarray:
    """Edges 0, 1, 2, 3, 4, 6, 10, ..., `last`: five to a factor of ten; int64."""
    edges = 10 ** (np.arange(5 * np.log10(max(last, 1))) / 5)
    return np.unique(np.concatenate([[0], edges.round(), [max(last, 1)]]).astype(np.int64))


def per_tick(at: np.ndarray, lived: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Events in each bin for each of the ticks `lived` in it; NaN where they are too few to say."""
    count = np.diff(until(np.sort(at), edges))
    return np.where(count >= FEW, count / np.maximum(lived, 1), np.nan)


def middle(edges: np.ndarray) -> np.ndarray:
    """Of the ticks in each bin, on a logarithmic axis."""
    return np.sqrt((edges[:-1] + 1) * edges[1:])


def until(rising: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """How many of `rising` are no later than each tick, int64."""
    return np.searchsorted(rising, ticks, side="right")


def _lived_by(since: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Sum of the ticks from each of `since` to an edge, where it is past."""
    since = np.sort(since)
    past = until(since, edges)
    return past * edges - _sum_first(since, past)


def _sum_first(values: np.ndarray, counts: np.ndarray) -> np.ndarray:
    return np.append(0, np.cumsum(values))[counts]
