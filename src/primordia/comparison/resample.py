"""Worlds drawn with replacement, for intervals; the draws come from our keys and are always the same.

Where several runs are held against one reference, their intervals hold together: the share of resamples
outside of each is divided by the number of contrasts (Bonferroni; Dunn 1961).
"""

import math
from collections.abc import Iterator

import numpy as np

from primordia.random.keys import encrypt
from primordia.random.wide import Wide

RESAMPLES = 1000
MISSED = 0.05
"""Share of resamples that lie outside an interval, or outside one or more that hold together."""
LEAST = 5
"""Fewest worlds of a run that are resampled. Even the whole range of n worlds holds the median of all
possible worlds with probability 1 - 2^(1 - n) only: 94 % for 5, 88 % for 4."""
NUMBERS = 2**18
"""Numbers of worlds that are drawn at once: the 1,000 resamples of 10,000 worlds would take 80 MB."""
OUTSIDE = 10
"""Fewest resamples that must lie beyond either end of an interval."""


def resamples(worlds: int, stream: int = 0, count: int = RESAMPLES) -> Iterator[np.ndarray]:
    """Yield `count` resamples in parts of K: the numbers of the worlds in each, int64 (K, worlds).

    Two runs whose worlds are independent use different streams, so their resamples are too.
    """
    key = Wide(np.full(1, stream, np.uint32), np.full(1, worlds, np.uint32))  # type: ignore[arg-type]
    part = max(NUMBERS // worlds, 1)
    for first in range(0, count, part):
        which, draw = np.indices((min(part, count - first), worlds), np.uint32)
        word = encrypt(key, Wide(which + np.uint32(first), draw)).hi  # type: ignore[arg-type]
        yield (np.asarray(word, np.uint64) * np.uint64(worlds) >> np.uint64(32)).astype(np.int64)


def interval(values: np.ndarray, missed: float = MISSED) -> tuple[np.ndarray, np.ndarray]:
    """Return the percentile interval of values of resamples, along the first axis (Efron 1979)."""
    ordered = np.sort(values, axis=0)
    outside = int(len(values) * missed / 2)
    return ordered[outside], ordered[len(values) - 1 - outside]


def enough(missed: float) -> int:
    """Return how many resamples an interval takes that misses so few of them."""
    return max(RESAMPLES, math.ceil(2 * OUTSIDE / missed))


def least(contrasts: int) -> int:
    """Return the fewest worlds of a run for intervals that hold together.

    The range of the worlds misses the median as much more rarely as the intervals must: one world more
    for twice the contrasts.
    """
    return LEAST + math.ceil(math.log2(contrasts))
