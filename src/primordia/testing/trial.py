"""What parts are tried with: numbers that look random and are the same in every check."""

import math
from typing import Any

import jax
import numpy as np

from primordia.random.gaussian import quantiles
from primordia.random.keys import bits
from primordia.random.wide import wide

ALL, COUNTS = 32, (1, 2, 31)
"""Organisms of a whole batch, and numbers of them that must come out the same by themselves."""

_DRAWN = jax.jit(bits)


def words(name: int, *shape: int) -> np.ndarray:
    """Return random words, uint32 of a shape; those of another name are others."""
    count = math.prod(shape)
    return np.asarray(_DRAWN(wide(name), np.arange(count)).hi).reshape(shape)


def normal(name: int, *shape: int) -> np.ndarray:
    """Return standard Gaussian numbers, float32 of a shape."""
    return quantiles()[words(name, *shape) >> np.uint32(16)]


def last(tree: Any, count: int) -> Any:
    """Return the last rows of a tree of arrays (N, ...)."""
    return jax.tree.map(lambda leaf: np.asarray(leaf)[len(leaf) - count :], tree)
