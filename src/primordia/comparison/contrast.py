"""One value of each world, some censored: quartiles, and one run against another.

The value of a world that stopped before it saturated is *at least* the births or ticks that it reached.
Nothing is assumed about the course of such a world after it stopped. A quartile is given by its bounds,
which are equal where it is known. The order of two worlds counts where it is known, and otherwise as a
tie (Gehan 1965). So every statement is exact, for any reason why worlds stopped.
"""

from dataclasses import dataclass

import numpy as np

from primordia.comparison.resample import LEAST, interval, resamples
from primordia.errors import InputError

WORDS = ((0.147, "negligible"), (0.33, "small"), (0.474, "medium"))
"""Words for an absolute delta below each number; above the last it is "large" (Romano et al. 2006)."""

Bounds = tuple[float, float]
"""Lower and upper bound of a value; infinity where no upper bound is known."""


@dataclass(frozen=True)
class Measured:
    """One value of each world, known or censored."""

    value: np.ndarray
    """float64 (W,)"""
    known: np.ndarray
    """bool (W,); where False, the true value is at least `value`"""

    @property
    def high(self) -> np.ndarray:
        """Upper bound of each value, float64 (W,)."""
        return np.where(self.known, self.value, np.inf)

    def before(self, horizon: float) -> "Measured":
        """Return the values censored at a horizon.

        Raises:
            InputError: a world stopped before the horizon, and its value is not known.
        """
        if (short := ~self.known & (self.value < horizon)).any():
            world = int(np.flatnonzero(short)[0])
            raise InputError(
                f"world {world} stopped at {self.value[world]:,.0f} before it saturated, so nothing is"
                f" known about it up to {horizon:,.0f}"
            )
        near = self.value < horizon
        return Measured(np.where(near, self.value, horizon), self.known & near)

    def quantile(self, q: float) -> Bounds:
        """Return bounds of the smallest value that a share q of worlds does not exceed."""
        low, high = (_quantile(each, q) for each in (self.value, self.high))
        return float(low), float(high)


@dataclass(frozen=True)
class Contrast:
    """The worlds of a run against the worlds of a reference, in one value."""

    delta: float
    """Cliff's delta (1993): share of pairs in which the run's value is larger, less the share in
    which it is smaller; -1 to 1"""
    decided: float
    """share of pairs whose order is known, or known to be a tie"""
    ratio: Bounds
    """median of the run over median of the reference"""
    interval: Bounds | None
    """interval that holds this ratio, with both its bounds, in 95 % of resamples of the worlds; None
    where one of the runs has fewer than LEAST worlds"""

    @property
    def word(self) -> str | None:
        """The word for the size of the effect; None without an interval."""
        if self.interval is None:
            return None
        return next((word for below, word in WORDS if abs(self.delta) < below), "large")


def contrast(run: Measured, reference: Measured) -> Contrast:
    """Compare the worlds of two runs, which are taken to be independent."""
    larger = _pairs(reference.high, run.value)
    smaller = _pairs(run.high, reference.value)
    one, other = (each.value[each.known] for each in (run, reference))
    equal = len(one) * len(other) - _pairs(one, other) - _pairs(other, one)
    pairs = len(run.value) * len(reference.value)
    least, most = _ratio(run.quantile(0.5), reference.quantile(0.5))
    return Contrast(
        delta=(larger - smaller) / pairs,
        decided=(larger + smaller + equal) / pairs,
        ratio=(float(least), float(most)),
        interval=_interval(run, reference),
    )


def _interval(run: Measured, reference: Measured) -> Bounds | None:
    """Return the interval of the ratio of medians; None where there are too few worlds."""
    if min(len(run.value), len(reference.value)) < LEAST:
        return None
    low, high = _ratio(_medians(run, 0), _medians(reference, 1))
    return float(interval(low)[0]), float(interval(high)[1])


def _pairs(small: np.ndarray, large: np.ndarray) -> int:
    """Return the number of pairs in which the value from `small` is below the value from `large`."""
    return int(np.searchsorted(np.sort(small), large, side="left").sum())


def _medians(measured: Measured, stream: int) -> tuple[np.ndarray, np.ndarray]:
    """Return both bounds of the median in each resample of the worlds, (RESAMPLES,) each."""
    rows = resamples(len(measured.value), stream)
    return _quantile(measured.value[rows], 0.5), _quantile(measured.high[rows], 0.5)


def _quantile(values: np.ndarray, q: float) -> np.ndarray:
    """Return a quantile along the last axis, as an order statistic, so that infinities do no harm."""
    place = max(int(np.ceil(q * values.shape[-1])) - 1, 0)
    return np.partition(values, place, axis=-1)[..., place]


def _ratio(run: tuple, reference: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds of a ratio from bounds of its terms: 0 to infinity unless both are positive."""
    with np.errstate(all="ignore"):
        low, high = np.divide(run[0], reference[1]), np.divide(run[1], reference[0])
    positive = np.minimum(run[0], reference[0]) > 0
    return np.where(positive, low, 0), np.where(positive, high, np.inf)
