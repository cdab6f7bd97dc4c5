"""Pairs of worlds: the two worlds of the same seed in two runs.

The worlds of a pair draw the same random words and have the same founders, and two forks of one run
share a past. So their values may be correlated. A resample therefore has both worlds of a seed or
neither. This is correct with and without correlation: the interval of correlated pairs is narrower,
and the interval of uncorrelated pairs is as wide as for independent worlds.
"""

from math import comb
from typing import NamedTuple

import numpy as np

from primordia.comparison.measured import Measured

Rows = tuple[np.ndarray, np.ndarray]
"""The worlds of one run and of another, int64 (W,) each; worlds at the same index are a pair."""


class Paired(NamedTuple):
    """The worlds of a run against the worlds of the same seeds in a reference."""

    pairs: int
    """number of pairs"""
    larger: int
    """number of pairs in which the run's world is known to have the larger value"""
    smaller: int
    """number of pairs in which the run's world is known to have the smaller value; all other pairs
    count as ties (Gehan 1965)"""

    @property
    def delta(self) -> float:
        """Share of pairs in which the run's value is larger, minus the share in which it is smaller."""
        return (self.larger - self.smaller) / self.pairs


def same_seeds(run: np.ndarray, reference: np.ndarray) -> Rows | None:
    """Return the pairs of worlds in the order of seeds, int64 (W,) for each run.

    None unless both runs have the same seeds, each once. Runs with only some common seeds are not
    paired, since their other worlds would be lost.
    """
    if len(run) != len(reference):
        return None
    rows = np.argsort(run, kind="stable"), np.argsort(reference, kind="stable")
    one, other = run[rows[0]], reference[rows[1]]
    return rows if (one == other).all() and (one[1:] > one[:-1]).all() else None


def paired(run: Measured, reference: Measured) -> Paired:
    """Count pairs where the run's value is larger, and where it is smaller; row k of each is pair k."""
    larger, smaller = run.value > reference.high, reference.value > run.high
    return Paired(len(run.value), int(larger.sum()), int(smaller.sum()))


def sign_test(larger: int, smaller: int) -> float:
    """Return the probability of a split at least this uneven if both signs are equally likely."""
    count = larger + smaller
    tail = sum(comb(count, k) for k in range(min(larger, smaller) + 1)) / 2**count
    return min(2 * tail, 1.0)
