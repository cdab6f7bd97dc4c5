"""What parts are tried with."""

from typing import Any

import jax
import numpy as np

ALL, COUNTS = 32, (1, 2, 31)
"""Organisms of a whole batch, and numbers of them that must come out the same by themselves."""


def last(tree: Any, count: int) -> Any:
    """Return the last rows of a tree of arrays (N, ...)."""
    return jax.tree.map(lambda leaf: np.asarray(leaf)[len(leaf) - count :], tree)
