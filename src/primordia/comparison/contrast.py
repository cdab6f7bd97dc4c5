"""One figure of each world, some known only from below: quartiles, and one run against another.

A world that stopped before it was saturated has a figure that is *at least* what it had come to.
Nothing is assumed of how such worlds would have gone on. A quartile is given by its bounds, which
are equal as soon as it is known; the order of two worlds counts if it is known, and otherwise as a
tie (Gehan 1965). So every statement is exact, whatever stopped the worlds.
"""

from dataclasses import dataclass

import numpy as np

from primordia.comparison.resample import interval, resamples
from primordia.errors import InputError

WORDS = ((0.147, "negligible"), (0.33, "small"), (0.474, "medium"))
"""What an absolute delta below this is called; above, "large" (Romano et al. 2006)."""

Bounds = tuple[float, float]
"""A figure is at least and at most so large; infinity where no upper bound is known."""


@dataclass(frozen=True)
class Figures:
    """One figure of each world."""

    value: np.ndarray
    """float64 (W,)"""
    known: np.ndarray
    """bool (W,); where False, the figure is at least `value`"""

    @property
    def high(self) -> np.ndarray:
        """What each figure is at most, float64 (W,)."""
        return np.where(self.known, self.value, np.inf)

    def before(self, horizon: float) -> "Figures":
        """What is known when one looks no further than a horizon.

        Raises:
            InputError: a world stopped on the way there, so it cannot be told.
        """
        if (short := ~self.known & (self.value < horizon)).any():
            world = int(np.flatnonzero(short)[0])
            raise InputError(
                f"world {world} stopped at {self.value[world]:,.0f}, not saturated, so nothing can"
                f" be said about it up to {horizon:,.0f}"
            )
        near = self.value < horizon
        return Figures(np.where(near, self.value, horizon), self.known & near)

    def quantile(self, q: float) -> Bounds:
        """The smallest figure that a share q of worlds does not exceed."""
        low, high = (_quantile(each, q) for each in (self.value, self.high))
        return float(low), float(high)


@dataclass(frozen=True)
class Contrast:
    """Worlds of a run against those of a reference."""

    delta: float
    """Cliff's delta (1993): share of pairs in which the run's figure is larger, less the share in
    which it is smaller; -1 to 1"""
    decided: float
    """share of pairs whose order is known, or known to be a tie"""
    ratio: Bounds
    """of the medians, run over reference"""
    interval: Bounds
    """that holds this ratio in 95 % of resamples of the worlds of both; it covers bounds too"""

    @property
    def word(self) -> str:
        """How large the effect is."""
        return next((word for below, word in WORDS if abs(self.delta) < below), "large")


def contrast(run: Figures, reference: Figures) -> Contrast:
    """Compare, worlds being independent of each other."""
    larger = _pairs(reference.high, run.value)
    smaller = _pairs(run.high, reference.value)
    one, other = (each.value[each.known] for each in (run, reference))
    equal = len(one) * len(other) - _pairs(one, other) - _pairs(other, one)
    pairs = len(run.value) * len(reference.value)
    low, high = _ratio(_medians(run, 0), _medians(reference, 1))
    of_medians = _ratio(run.quantile(0.5), reference.quantile(0.5))
    return Contrast(
        delta=(larger - smaller) / pairs,
        decided=(larger + smaller + equal) / pairs,
        ratio=(float(of_medians[0]), float(of_medians[1])),
        interval=(float(interval(low)[0]), float(interval(high)[1])),
    )


def _pairs(small: np.ndarray, large: np.ndarray) -> int:
    """How many pairs there are of a smaller one of `small` and a larger one of `large`."""
    return int(np.searchsorted(np.sort(small), large, side="left").sum())


def _medians(figures: Figures, stream: int) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the median in each resample of the worlds."""
    rows = resamples(len(figures.value), stream)
    return _quantile(figures.value[rows], 0.5), _quantile(figures.high[rows], 0.5)


def _quantile(values: np.ndarray, q: float) -> np.ndarray:
    """Along the last axis. An order statistic, so infinities do no harm."""
    place = max(int(np.ceil(q * values.shape[-1])) - 1, 0)
    return np.partition(values, place, axis=-1)[..., place]


def _ratio(run: tuple, reference: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of a ratio from bounds of its terms: 0 to infinity unless both are surely positive."""
    with np.errstate(all="ignore"):
        low, high = np.divide(run[0], reference[1]), np.divide(run[1], reference[0])
    positive = np.minimum(run[0], reference[0]) > 0
    return np.where(positive, low, 0), np.where(positive, high, np.inf)
