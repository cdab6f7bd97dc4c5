"""Quantiles of values that may be infinite."""

import numpy as np


def quantile(values: np.ndarray, q: float) -> np.ndarray:
    """Return the smallest value that a share q of the values (..., N) does not exceed, (...).

    The quantile is one of the values, never a mean of two, so infinities are allowed.
    """
    place = max(int(np.ceil(q * values.shape[-1])) - 1, 0)
    return np.partition(values, place, axis=-1)[..., place]
