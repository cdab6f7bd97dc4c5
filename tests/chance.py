"""Bounds that chance keeps: five standard deviations, or as unlikely. Seeds in tests are fixed."""

import math

import numpy as np


def binomial(count: int, n: int, p: float) -> bool:
    """Whether `count` of n trials of probability p is within five standard deviations."""
    return abs(count - n * p) <= 5 * math.sqrt(n * p * (1 - p))


def even(counts: np.ndarray) -> bool:
    """Whether these counts are of equally likely outcomes: chi-square below its 1 - 3e-7 quantile.

    The quantile is that of Wilson and Hilferty (1931).
    """
    expected, freedom = counts.mean(), len(counts) - 1
    square = ((counts - expected) ** 2 / expected).sum()
    most = freedom * (1 - 2 / (9 * freedom) + 5 * math.sqrt(2 / (9 * freedom))) ** 3
    return bool(expected >= 20 and square <= most)
