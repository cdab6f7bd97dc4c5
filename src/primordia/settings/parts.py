"""Replaceable parts of a run, such as a brain: classes found by name or as `module:Class`."""

from collections.abc import Mapping
from importlib import import_module


def find(what: str, name: object, known: Mapping[str, str]) -> type:
    """Return the class of a part.

    Args:
        what: the kind of part, such as `habitat`; for messages.
        name: one of the known names, or `module:Class`.
        known: `module:Class` of each part that comes with the package, by name.

    Raises:
        LookupError: there is no such name, module or class; the message says which.
    """
    path = known.get(name, name) if isinstance(name, str) else ""
    module, _, attribute = path.partition(":")
    if not module or not attribute:
        raise LookupError(f"no {what} named {name!r}; known: {', '.join(known)}, or module:Class")
    try:
        part = getattr(import_module(module), attribute)
    except Exception as error:  # the module is the user's, and may raise anything
        raise LookupError(f"{what} {name!r} cannot be loaded: {error}") from error
    if not isinstance(part, type):
        raise LookupError(f"{what} {name!r} is not a class; name one as module:Class")
    return part
