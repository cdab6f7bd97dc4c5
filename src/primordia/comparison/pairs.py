"""Pairs of worlds: those of one seed in two runs.

Such worlds draw the same random words, from the same founders on, until something makes them differ; two
forks of one run share a past. So they may be alike. Resamples therefore draw pairs: both worlds of a
seed are in a resample, or neither. That is right whether they are alike or not. If they are alike, the
interval is narrower; if not, it is as wide as that of independent worlds.
"""

from typing import NamedTuple

import numpy as np

from primordia.comparison.measured import Measured

Rows = tuple[np.ndarray, np.ndarray]
"""The worlds of two runs, pair by pair, int64 (W,) each."""


class Paired(NamedTuple):
    """The worlds of a run against the worlds of the same seeds in a reference."""

    pairs: int
    """number of pairs"""
    larger: int
    """pairs in which the run's world is known to have the larger value"""
    smaller: int
    """pairs in which it is known to have the smaller one; all others are ties (Gehan 1965)"""

    @property
    def delta(self) -> float:
        """Share of pairs in which the run's value is larger, less the share in which it is smaller."""
        return (self.larger - self.smaller) / self.pairs


def same_seeds(run: np.ndarray, reference: np.ndarray) -> Rows | None:
    """Return the pairs of worlds in the order of seeds, uint64 (W,) for each run.

    It is None unless both runs have the same seeds, each once. Some seeds in common make no pairs: the
    other worlds would be lost.
    """
    if len(run) != len(reference):
        return None
    rows = np.argsort(run, kind="stable"), np.argsort(reference, kind="stable")
    one, other = run[rows[0]], reference[rows[1]]
    return rows if (one == other).all() and (one[1:] > one[:-1]).all() else None


def paired(run: Measured, reference: Measured) -> Paired:
    """Count the pairs by their order; the worlds of both runs are in the order of pairs."""
    larger, smaller = run.value > reference.high, reference.value > run.high
    return Paired(len(run.value), int(larger.sum()), int(smaller.sum()))
