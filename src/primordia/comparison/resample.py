"""Worlds drawn with replacement, for intervals; the draws come from our keys and are always the same."""

import numpy as np

from primordia.random.keys import threefry
from primordia.random.wide import Wide

RESAMPLES = 1000
COVERED = 0.95
"""Share of resamples that lie within an interval."""
LEAST = 5
"""Fewest worlds of a run that are resampled. Even the whole range of n worlds holds the median of all
possible worlds with probability 1 - 2^(1 - n) only: 94 % for 5, 88 % for 4."""


def resamples(worlds: int, stream: int = 0) -> np.ndarray:
    """Return the numbers of the worlds in each resample, int64 (RESAMPLES, worlds).

    Two runs that are compared use different streams, so their resamples are independent.
    """
    which, draw = np.indices((RESAMPLES, worlds), np.uint32)
    key = Wide(np.full(1, stream, np.uint32), np.full(1, worlds, np.uint32))  # type: ignore[arg-type]
    word = np.asarray(threefry(key, Wide(which, draw)).hi)  # type: ignore[arg-type]
    return (word.astype(np.uint64) * np.uint64(worlds) >> np.uint64(32)).astype(np.int64)


def interval(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the percentile interval of values of resamples, along the first axis (Efron 1979)."""
    ordered = np.sort(values, axis=0)
    outside = round(len(values) * (1 - COVERED) / 2)
    return ordered[outside], ordered[len(values) - 1 - outside]
