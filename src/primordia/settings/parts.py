"""Replaceable parts of a run, such as a brain: classes found by name or as `module:Class`."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from pydantic import ValidationError

from primordia.errors import InputError
from primordia.settings.fields import first_fault


def find(what: str, name: object, known: Mapping[str, str], base: type = object) -> type[Any]:
    """Return the class of a part.

    Args:
        what: the kind of part, such as `habitat`; for messages.
        name: one of the known names, or `module:Class`.
        known: `module:Class` of each part that comes with the package, by name.
        base: the class that such parts are subclasses of.

    Raises:
        LookupError: there is no such name, module or class; the message says which.
    """
    path = known.get(name, name) if isinstance(name, str) else ""
    module, _, attribute = path.partition(":")
    if not module or not attribute:
        raise LookupError(f"no {what} named {name!r}; known: {', '.join(known)}, or module:Class")
    try:
        found = getattr(import_module(module), attribute)
    except Exception as error:  # the module is the user's, and may raise anything
        raise LookupError(f"{what} {name!r} cannot be loaded: {error}") from error
    if not isinstance(found, type):
        raise LookupError(f"{what} {name!r} is not a class")
    if not issubclass(found, base):
        raise LookupError(
            f"{found.__name__} is no {what}: make it a subclass of {base.__module__}.{base.__name__}"
        )
    return found


def build(
    what: str,
    key: str,
    table: Mapping[str, Any],
    known: Mapping[str, str],
    base: type,
) -> Any:
    """Return the part that a table of settings describes.

    Args:
        what: the kind of part, and the name of the table in a task.
        key: the setting that names the part's class; the others are the class's own.
        table: settings by name.
        known: `module:Class` of each part that comes with the package, by name.
        base: the class that such parts are subclasses of.

    Raises:
        InputError: there is no such part, or it does not take these settings.
    """
    own = dict(table)
    try:
        kind = find(what, own.pop(key, ""), known, base)
    except LookupError as error:
        raise InputError(f"{what}.{key}: {error}") from None
    try:
        return kind(**own)
    except ValidationError as error:
        raise InputError(first_fault(error, kind, what)) from None
    except (LookupError, TypeError, ValueError) as error:
        raise InputError(f"{what}: {error}") from None
