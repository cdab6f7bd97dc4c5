"""Random numbers for trials of parts: they are the same in every call, and no run uses them."""

import math
from typing import Any

import numpy as np

from primordia.random.gaussian import quantiles
from primordia.random.keys import bits
from primordia.random.wide import wide


def words(name: int, *shape: int) -> np.ndarray:
    """Return random words, uint32 of a shape, that depend on a name."""
    counters: Any = np.arange(math.prod(shape))
    return np.asarray(bits(wide(name), counters).hi).reshape(shape)


def normal(name: int, *shape: int) -> np.ndarray:
    """Return standard Gaussian numbers, float32 of a shape."""
    return quantiles()[words(name, *shape) >> np.uint32(16)]
