"""Functions for all checks: comparisons bit for bit, and messages about a part that fails."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import jax
import numpy as np

from primordia.errors import InputError
from primordia.settings.tracing import Tracing

SUMMED = (
    "; compilers sum in different orders: use brains.layers in brains, and elsewhere add single"
    " numbers, not axes"
)


ALL, COUNTS = 32, (1, 2, 31)
"""Number of organisms of a whole batch, and of smaller batches that must give the same results."""


class ContractError(AssertionError):
    """A part does not keep its contract."""


@contextmanager
def kept() -> Iterator[None]:
    """Raise ContractError in place of the InputError of a check that is made before a run, too."""
    try:
        yield
    except InputError as error:
        raise ContractError(str(error).partition(": ")[2]) from None


def need(holds: object, part: object, says: str) -> None:
    """Raise ContractError unless a condition holds."""
    if not holds:
        raise ContractError(f"{type(part).__name__} {says}")


def typed(part: object, what: str, array: Any, shape: tuple[int, ...], dtype: Any) -> None:
    """Raise ContractError if an array has another shape or dtype than these."""
    with kept():
        Tracing("part", part).typed(what, array, shape, dtype)


def last(tree: Any, count: int) -> Any:
    """Return the last rows of a tree of arrays (N, ...)."""
    return jax.tree.map(lambda leaf: np.asarray(leaf)[len(leaf) - count :], tree)


def same(part: object, one: Any, other: Any, says: str, first: int = 0) -> None:
    """Raise ContractError if two trees of arrays (N, ...) differ in a bit; row 0 is organism `first`."""
    pairs = zip(jax.tree.leaves(one), jax.tree.leaves(other), strict=True)
    differ = [
        row
        for a, b in pairs
        for row, (x, y) in enumerate(zip(np.asarray(a), np.asarray(b), strict=True))
        if x.tobytes() != y.tobytes()
    ]
    if differ:
        raise ContractError(
            f"{type(part).__name__} gives different bits for organism {first + min(differ)} {says}"
        )


def advise(part: object) -> None:
    """Warn if equal parts do not share their compiled code."""
    try:
        hash(part)
        shares = type(part).__eq__ is not object.__eq__
    except TypeError:
        shares = False
    if not shares:
        warnings.warn(
            f"{type(part).__name__} is not hashed by its values, so each run compiles it again;"
            " make the class a subclass of Settings without dictionaries and lists, or define __hash__",
            stacklevel=3,
        )
