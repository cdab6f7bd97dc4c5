"""Contrasts: an outcome in a run's worlds against the same outcome in a reference's worlds.

Two worlds whose order is unknown count as a tie (Gehan 1965).
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from primordia.comparison import needed
from primordia.comparison.measured import Bounds, Measured
from primordia.comparison.pairs import Paired, Rows, paired
from primordia.comparison.resample import LEAST, MISSED, enough, interval, least, resamples
from primordia.history.series import plain

WORDS = ((0.147, "negligible"), (0.33, "small"), (0.474, "medium"))
"""The word for an absolute delta below each number; from the last number on it is "large" (Romano et al.
2006)."""


@dataclass(frozen=True)
class Contrast:
    """An outcome in a run's worlds against the same outcome in a reference's worlds."""

    delta: float
    """Cliff's delta (1993): share of all pairs of worlds in which the run's value is larger, minus
    the share in which the run's value is smaller; -1 to 1"""
    decided: float
    """share of these pairs whose order is known; known ties are included"""
    paired: Paired | None
    """the pairs of worlds with equal seeds; None unless both runs have the same seeds"""
    ratio: Bounds
    """median of the run divided by median of the reference"""
    coverage: float
    """share of resamples in `interval`: 0.95 for one contrast, more for several simultaneous ones"""
    interval: Bounds | None
    """interval of the ratio; `coverage` is the share of resamples (of worlds or pairs) with both
    bounds of the ratio in it; None if one of the runs has too few worlds, see `resample.least`"""
    worlds: int
    """number of worlds of the smaller run"""

    @property
    def word(self) -> str | None:
        """The word for the size of the effect; None if one of the runs has fewer worlds than LEAST."""
        if self.worlds < LEAST:
            return None
        return next((word for below, word in WORDS if abs(self.delta) < below), "large")

    @property
    def needed(self) -> int | None:
        """Number of worlds that each run needs so that 80 % of experiments find this effect: `needed`.

        The test's significance level is 1 minus the interval's coverage. None if there is no
        effect, or one of the runs has fewer worlds than LEAST.
        """
        if self.worlds < LEAST:
            return None
        missed = 1 - self.coverage
        if self.paired is not None:
            return needed.of_pairs(self.paired, missed)
        return needed.of_each_run(self.delta, missed)

    def to_dict(self) -> dict[str, Any]:
        """Return plain values for JSON; an unknown bound is None."""
        pairs = self.paired and {"pairs": self.paired.pairs, "delta": self.paired.delta}
        return {
            "delta": self.delta,
            "word": self.word,
            "decided": self.decided,
            "same_seeds": pairs,
            "ratio": plain(self.ratio),
            "interval": self.interval and plain(self.interval),
            "coverage": self.coverage,
            "needed": self.needed,
        }


def contrast(
    run: Measured, reference: Measured, pairs: Rows | None = None, contrasts: int = 1
) -> Contrast:
    """Compare the worlds of two runs.

    Args:
        run: one value of each world of the run.
        reference: the same value of each world of the reference.
        pairs: the worlds of the same seeds; None if the worlds of both runs are independent.
        contrasts: number of contrasts whose intervals hold simultaneously.
    """
    if pairs is not None:
        run, reference = run.take(pairs[0]), reference.take(pairs[1])
    larger = _pairs(reference.high, run.value)
    smaller = _pairs(run.high, reference.value)
    one, other = (each.value[each.known] for each in (run, reference))
    equal = len(one) * len(other) - _pairs(one, other) - _pairs(other, one)
    total = len(run.value) * len(reference.value)
    low, high = _ratio(run.quantile(0.5), reference.quantile(0.5))
    worlds = min(len(run.value), len(reference.value))
    missed, streams = MISSED / contrasts, (0, 1 if pairs is None else 0)
    return Contrast(
        delta=(larger - smaller) / total,
        decided=(larger + smaller + equal) / total,
        paired=None if pairs is None else paired(run, reference),
        ratio=(float(low), float(high)),
        coverage=1 - missed,
        interval=_interval((run, reference), streams, missed)
        if worlds >= least(contrasts)
        else None,
        worlds=worlds,
    )


def _interval(runs: tuple[Measured, Measured], streams: tuple[int, int], missed: float) -> Bounds:
    """Return the interval of the ratio of medians; runs with a common stream are resampled together."""
    one, other = (_medians(*each, enough(missed)) for each in zip(runs, streams, strict=True))
    low, high = _ratio(one, other)
    return float(interval(low, missed)[0]), float(interval(high, missed)[1])


def _medians(run: Measured, stream: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds of the median in each resample of the worlds, each float64 (count,)."""
    parts = map(run.take, resamples(len(run.value), stream, count))
    middle = partial(np.quantile, q=0.5, axis=-1, method="inverted_cdf")
    bounds = [(middle(part.value), middle(part.high)) for part in parts]
    low, high = map(np.concatenate, zip(*bounds, strict=True))
    return low, high


def _pairs(small: np.ndarray, large: np.ndarray) -> int:
    """Return the number of pairs in which the value from `small` is below the value from `large`."""
    return int(np.searchsorted(np.sort(small), large, side="left").sum())


def _ratio(run: tuple, reference: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds of a ratio from bounds of its terms: 0 to infinity unless both terms are positive."""
    with np.errstate(all="ignore"):
        low, high = np.divide(run[0], reference[1]), np.divide(run[1], reference[0])
    positive = np.minimum(run[0], reference[0]) > 0
    return np.where(positive, low, 0), np.where(positive, high, np.inf)
