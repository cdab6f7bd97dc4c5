"""One figure of each world, some known only from below: quartiles, and one run against another.

A world that stopped before it was saturated has a figure that is *at least* what it had come to.
Nothing is assumed of how such worlds would have gone on. A quartile is given by its bounds, which
are equal as soon as it is known; the order of two worlds counts if it is known, and otherwise as a
tie (Gehan 1965). So every statement is exact, whatever stopped the worlds.
"""

from dataclasses import dataclass

import numpy as np

from primordia.errors import InputError
from primordia.resample import interval, resamples

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
    larger, smaller = _exceeds(run, reference), _exceeds(reference, run).T
    equal = (run.value[:, None] == reference.value) & (run.known[:, None] & reference.known)
    medians = run.quantile(0.5), reference.quantile(0.5)
    drawn = [
        [_quantile(bound[resamples(len(bound), stream)], 0.5) for bound in (each.value, each.high)]
        for stream, each in enumerate((run, reference))
    ]
    low, high = _ratio(*(tuple(each) for each in drawn))
    return Contrast(
        delta=float(larger.mean() - smaller.mean()),
        decided=float((larger | smaller | equal).mean()),
        ratio=tuple(float(each) for each in _ratio(*medians)),  # type: ignore[arg-type]
        interval=(float(interval(low)[0]), float(interval(high)[1])),
    )


def _quantile(values: np.ndarray, q: float) -> np.ndarray:
    """Along the last axis. An order statistic, so infinities do no harm."""
    place = max(int(np.ceil(q * values.shape[-1])) - 1, 0)
    return np.partition(values, place, axis=-1)[..., place]


def _exceeds(one: Figures, other: Figures) -> np.ndarray:
    """Whose figure is known to be larger than whose, bool (W of one, W of other)."""
    return one.value[:, None] > other.high


def _ratio(run: tuple, reference: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of a ratio of two figures given by theirs: from nothing to infinity if need be."""
    with np.errstate(divide="ignore", invalid="ignore"):
        low = np.divide(run[0], reference[1])
        high = np.divide(run[1], reference[0])
    return np.nan_to_num(low, nan=0.0, posinf=np.inf), np.nan_to_num(
        high, nan=np.inf, posinf=np.inf
    )
