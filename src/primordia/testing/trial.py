"""Inputs for checks of parts."""

from typing import Any

import jax
import numpy as np

ALL, COUNTS = 32, (1, 2, 31)
"""Number of organisms of a whole batch, and of smaller batches that must give the same results."""


def last(tree: Any, count: int) -> Any:
    """Return the last rows of a tree of arrays (N, ...)."""
    return jax.tree.map(lambda leaf: np.asarray(leaf)[len(leaf) - count :], tree)
