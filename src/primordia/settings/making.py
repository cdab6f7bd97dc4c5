"""Replaceable parts, made from tables of settings; one setting of a table names the part."""

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from pydantic import ValidationError

from primordia.errors import InputError
from primordia.settings.fields import first_fault
from primordia.settings.tables import DEFAULTS, PARTS

Part = TypeVar("Part")


def make(what: str, table: Mapping[str, Any], find: Callable[[object], type[Part]]) -> Part:
    """Return the part that a table describes.

    Args:
        what: the kind of part and the name of its table, one of PARTS.
        table: settings by name; a table that names no part describes the part in DEFAULTS.
        find: name -> the part's class; LookupError if there is none.

    Raises:
        InputError: there is no such part, or the part does not take these settings.
    """
    own, key = dict(table), PARTS[what]
    try:
        kind = find(own.pop(key, DEFAULTS.get(what, "")))
    except LookupError as error:
        raise InputError(f"{what}.{key}: {error}") from None
    try:
        return kind(**own)
    except ValidationError as error:
        raise InputError(first_fault(error, kind, what)) from None
    except (LookupError, TypeError, ValueError) as error:
        raise InputError(f"{what}: {error}") from None
