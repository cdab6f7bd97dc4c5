"""Compiled code, shared by all in a process that compute the same: a second run needs no more."""

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any

import jax

KEPT = 64
"""functions, those used last; each with its code for every shape it was called with"""


def shared(function: Callable, *fixed: Any, donate: tuple[int, ...] = ()) -> Callable:
    """`jax.jit` of a pure function of a module or class whose first arguments are `fixed`, pure too.

    Where function and `fixed` are equal, so is the code; what cannot be hashed shares with nothing.
    `donate` are those of the other arguments that are used up, as in `donate_argnums`.
    """
    try:
        hash(fixed)
    except TypeError:
        return _jitted(function, fixed, donate)
    return _kept(function, fixed, donate)


def _jitted(function: Callable, fixed: tuple, donate: tuple[int, ...]) -> Callable:
    return jax.jit(partial(function, *fixed), donate_argnums=donate)


_kept = lru_cache(maxsize=KEPT)(_jitted)
