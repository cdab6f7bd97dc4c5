"""Compiled functions, which round in the same way everywhere and are shared within a process."""

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any

import jax
import numpy as np

from primordia.rounding import rounded

KEPT = 64
"""number of compiled functions kept: the most recently used, each with its code for all shapes of a
call"""


def jit(function: Callable, donate: tuple[int, ...] = ()) -> Callable:
    """Return `jax.jit` of a function whose results depend on no compiler's choices (see `rounding`).

    Args:
        function: a pure function of trees of arrays.
        donate: positions of arguments whose memory a call may reuse; see JAX's `donate_argnums`.
    """
    compute = rounded(function)
    named = function.func if isinstance(function, partial) else function
    compute.__name__ = getattr(named, "__name__", "function")  # for JAX's own messages
    return partial(jax.jit(compute, donate_argnums=[place + 1 for place in donate]), np.uint32(0))


def shared(function: Callable, *fixed: Any, donate: tuple[int, ...] = ()) -> Callable:
    """Return `jit` of a function with its first arguments bound to `fixed`.

    Calls share one compiled function if their `function` and `fixed` are equal. If `fixed` cannot
    be hashed, the function is compiled for this caller alone.

    Args:
        function: a pure function of a module or a class.
        fixed: the function's first arguments, which never change.
        donate: arguments whose memory a call may reuse, by position after `fixed`; see `donate_argnums`.
    """
    try:
        hash(fixed)
    except TypeError:
        return _jitted(function, fixed, donate)
    return _kept(function, fixed, donate)


def _jitted(function: Callable, fixed: tuple, donate: tuple[int, ...]) -> Callable:
    return jit(partial(function, *fixed), donate)


_kept = lru_cache(maxsize=KEPT)(_jitted)
