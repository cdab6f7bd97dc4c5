"""The functions of a part, called or traced before a run; a fault is one line that names the part."""

import traceback
from collections.abc import Callable
from inspect import getsourcefile
from pathlib import Path
from typing import Any, TypeVar

import jax
import jax.numpy as jnp

from primordia.errors import InputError

Result = TypeVar("Result")
COUNT = 32
"""Number of bodies, organisms or births in a trace."""


class Tracing:
    """A part of a run (habitat, brain or mutation) whose functions are checked."""

    def __init__(self, kind: str, part: object) -> None:
        """Take the part, and the name of its table in settings."""
        self._part, self._start = part, f"{kind}: {type(part).__name__} "

    def called(self, name: str, function: Callable[..., Result], *arguments: Any) -> Result:
        """Return what a function returns; `name` is its name in the contract.

        Raises:
            InputError: the function fails.
        """
        try:
            return function(*arguments)
        except InputError:
            raise
        except (Exception, SystemExit) as error:  # the part may be the user's
            text = (str(error).splitlines() or [""])[0]
            says = f"{type(error).__name__}: {text}".removesuffix(": ")
            raise self.fault(f"fails in {name}: {says}{self._line_of(error)}") from None

    def traced(self, name: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return the shapes and dtypes of what a function returns; nothing is computed. See `called`."""
        return self.called(name, jax.eval_shape, function, *arguments)

    def need(self, holds: object, says: str) -> None:
        """Raise InputError unless a condition holds."""
        if not holds:
            raise self.fault(says)

    def typed(self, what: str, found: Any, shape: tuple[int, ...], dtype: Any) -> None:
        """Raise InputError if a result has another shape or dtype than these."""
        wanted = f"{jnp.dtype(dtype)} {shape}"
        is_array = hasattr(found, "dtype") and hasattr(found, "shape")
        given = f"{found.dtype} {tuple(found.shape)}" if is_array else f"{found!r}"
        self.need(given == wanted, f"gives {what} as {given}; the contract says {wanted}")

    def fault(self, says: str) -> InputError:
        """Return the error for a fault of the part."""
        return InputError(self._start + says)

    def _line_of(self, error: BaseException) -> str:
        """Return the last line of the part's file that an error went through."""
        try:
            file = getsourcefile(type(self._part))
        except TypeError:
            return ""
        frames = traceback.extract_tb(error.__traceback__)
        lines = [each.lineno for each in frames if each.filename == file]
        return f" ({Path(file or '').name}, line {lines[-1]})" if lines else ""
