"""Resamples of worlds (with replacement) for intervals. The draws come from fixed keys.

If several runs are compared with one reference, their intervals hold simultaneously: the share of
resamples outside each interval is divided by the number of contrasts (Bonferroni; Dunn 1961).
"""

import math
from collections.abc import Iterator

import numpy as np

from primordia.random.keys import encrypt
from primordia.random.wide import Wide

RESAMPLES = 1000
MISSED = 0.05
"""Share of resamples outside an interval, or outside at least one of several simultaneous ones."""
LEAST = 5
"""A run's worlds are resampled only if there are at least this many. The whole range of n worlds
holds the median of all possible worlds only with probability 1 - 2^(1 - n): 94 % for 5, 88 % for 4."""
NUMBERS = 2**18
"""Largest number of worlds that are drawn at once: all 1,000 resamples of 10,000 worlds would take
80 MB."""
OUTSIDE = 10
"""Smallest number of resamples beyond either end of an interval."""


def resamples(worlds: int, stream: int = 0, count: int = RESAMPLES) -> Iterator[np.ndarray]:
    """Yield resamples, `count` in all, K at once: the numbers of the drawn worlds, int64 (K, worlds).

    Two runs with independent worlds use different streams, so that their resamples are independent.
    """
    key = Wide(np.full(1, stream, np.uint32), np.full(1, worlds, np.uint32))  # type: ignore[arg-type]
    part = max(NUMBERS // worlds, 1)
    for first in range(0, count, part):
        which, draw = np.indices((min(part, count - first), worlds), np.uint32)
        word = encrypt(key, Wide(which + np.uint32(first), draw)).hi  # type: ignore[arg-type]
        yield (np.asarray(word, np.uint64) * np.uint64(worlds) >> np.uint64(32)).astype(np.int64)


def interval(values: np.ndarray, missed: float = MISSED) -> tuple[np.ndarray, np.ndarray]:
    """Return the percentile interval of resampled values, along the first axis (Efron 1979)."""
    ordered = np.sort(values, axis=0)
    outside = int(len(values) * missed / 2)
    return ordered[outside], ordered[len(values) - 1 - outside]


def enough(missed: float) -> int:
    """Return the number of resamples for an interval; `missed` is the share outside it."""
    return max(RESAMPLES, math.ceil(2 * OUTSIDE / missed))


def least(contrasts: int) -> int:
    """Return the smallest number of worlds of a run for simultaneous intervals.

    Twice as many contrasts need one world more, since each world halves the probability that the range
    of the worlds misses the median.
    """
    return LEAST + math.ceil(math.log2(contrasts))
