"""Replaceable parts of a run, such as a brain: classes found by name or as `module:Class`."""

from collections.abc import Mapping
from typing import Any

from primordia import own_code


def find(what: str, name: object, known: Mapping[str, str], base: type) -> type:
    """Return the class of a part.

    Args:
        what: the kind of part, such as `habitat`; for messages.
        name: one of the known names, or `module:Class`.
        known: `module:Class` of each part that comes with the package, by name.
        base: the base class of parts of this kind.

    Raises:
        LookupError: there is no such name, module or class, or the class is not a part of this
            kind; the message says which.
    """
    found = load(what, name, known)
    if not isinstance(found, type):
        raise LookupError(f"{what} {name!r} is not a class")
    if not issubclass(found, base):
        raise LookupError(
            f"{found.__name__} is not a {what}: make it a subclass of"
            f" {base.__module__}.{base.__name__}"
        )
    return found


def load(what: str, name: object, known: Mapping[str, str]) -> Any:
    """Return a part that is a class or a function; see `find`."""
    path = known.get(name, name) if isinstance(name, str) else ""
    module, _, attribute = path.partition(":")
    if not module or not attribute:
        raise LookupError(f"no {what} named {name!r}; known: {', '.join(known)}, or module:Class")
    try:
        return getattr(own_code.load(module), attribute)
    except (Exception, SystemExit) as error:  # the user's module may raise any error
        raise LookupError(f"{what} {name!r} cannot be loaded: {error}") from error
