"""Random numbers for trials of parts: they are the same in every call, and no run uses them."""

import math

import jax
import numpy as np

from primordia.random.gaussian import quantiles
from primordia.random.keys import bits
from primordia.random.wide import wide

_DRAWN = jax.jit(bits)


def words(name: int, *shape: int) -> np.ndarray:
    """Return random words, uint32 of a shape, that depend on a name."""
    count = math.prod(shape)
    return np.asarray(_DRAWN(wide(name), np.arange(count)).hi).reshape(shape)


def normal(name: int, *shape: int) -> np.ndarray:
    """Return standard Gaussian numbers, float32 of a shape."""
    return quantiles()[words(name, *shape) >> np.uint32(16)]
