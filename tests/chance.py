"""Bounds for random counts: five standard deviations, or the same probability. Seeds are fixed."""

import math

import numpy as np


def binomial(count: int, n: int, p: float) -> bool:
    """Return whether `count` of n trials of probability p is within five standard deviations."""
    return abs(count - n * p) <= 5 * math.sqrt(n * p * (1 - p))


def even(counts: np.ndarray) -> bool:
    """Return whether these may be counts of equally likely outcomes.

    Chi-square must be below its 1 - 3e-7 quantile, which is that of Wilson and Hilferty (1931).
    """
    expected, freedom = counts.mean(), len(counts) - 1
    square = ((counts - expected) ** 2 / expected).sum()
    most = freedom * (1 - 2 / (9 * freedom) + 5 * math.sqrt(2 / (9 * freedom))) ** 3
    return bool(expected >= 20 and square <= most)
