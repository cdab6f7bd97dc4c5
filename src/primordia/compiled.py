"""Compiled functions, shared within a process: a second run of the same law compiles nothing."""

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any

import jax

KEPT = 64
"""number of compiled functions kept: the most recently used, each with its code for all shapes of a
call"""


def shared(function: Callable, *fixed: Any, donate: tuple[int, ...] = ()) -> Callable:
    """Return `jax.jit` of a function with its first arguments bound to `fixed`.

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
    return jax.jit(partial(function, *fixed), donate_argnums=donate)


_kept = lru_cache(maxsize=KEPT)(_jitted)
