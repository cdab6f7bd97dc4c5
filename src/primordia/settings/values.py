"""Checks of single values before settings are validated: arrays and files must be able to hold them."""

import math
import re
from os import PathLike, fspath
from typing import Any

import numpy as np

from primordia.errors import InputError

DEEPEST = 16
"""Largest number of levels of nested tables and lists."""
LARGEST = 3.4028234663852886e38
"""Largest float32."""
UNWRITABLE = re.compile("[\0\ud800-\udfff]")
"""Characters that UTF-8 or TOML cannot hold: NUL, and halves of surrogate pairs."""
SHOWN = 100
"""Largest number of characters of a value in a message."""


def plain(values: Any, depth: int = 0) -> Any:
    """Return nested tables and lists with Python's numbers in place of NumPy's, and texts for paths.

    What is nested too deeply stays as it is, for `check_values` to refuse.
    """
    if isinstance(values, dict) and depth <= DEEPEST:
        return {name: plain(value, depth + 1) for name, value in values.items()}
    if isinstance(values, list | tuple) and depth <= DEEPEST:
        return [plain(value, depth + 1) for value in values]
    if isinstance(values, PathLike):
        return fspath(values)
    return values.item() if isinstance(values, np.generic) else values


def check_values(values: Any, path: str = "", depth: int = 0) -> None:
    """Check the values of settings in nested tables, but not what they mean.

    Args:
        values: a value, or a table or list of values.
        path: the value's dotted name, for messages.
        depth: the number of tables and lists around the value.

    Raises:
        InputError: a number is not finite, or does not fit into 64 bits or float32; a text cannot be
            written as UTF-8, or has a NUL; a name cannot be printed; tables are nested too deeply.
    """
    if isinstance(values, dict | list | tuple):
        if depth > DEEPEST:
            raise InputError(f"{shown(path)} is nested more than {DEEPEST} levels deep")
        named = values.items() if isinstance(values, dict) else enumerate(values)
        for name, value in named:
            if not str(name).isprintable():
                raise InputError(f"there is no setting {shown(f'{path}.{name}'.removeprefix('.'))}")
            check_values(value, f"{path}.{name}".removeprefix("."), depth + 1)
    elif isinstance(values, int) and not -(2**63) <= values < 2**64:
        raise InputError(f"{path}: {shown(values)} does not fit into 64 bits")
    elif isinstance(values, float) and not abs(values) <= LARGEST:
        unfit = "does not fit into float32" if math.isfinite(values) else "is not a finite number"
        raise InputError(f"{path}: {values} {unfit}")
    elif isinstance(values, str) and UNWRITABLE.search(values):
        raise InputError(f"{path}: {shown(values)} has a character that a text file cannot hold")


def shown(value: object) -> str:
    """Return the `repr` of a value, shortened for a message."""
    text = hex(value) if isinstance(value, int) and value.bit_length() > SHOWN else repr(value)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 3]}..."
