"""The sign test."""

from math import comb


def sign_test(one: int, other: int) -> float:
    """Return the probability of a split at least this uneven if both signs are equally likely."""
    least, count = min(one, other), one + other
    tail = sum(comb(count, k) for k in range(least + 1)) / 2**count
    return min(2 * tail, 1.0)
