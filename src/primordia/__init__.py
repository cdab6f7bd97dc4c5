"""Primordia: neural organisms that live, die and copy themselves in any simulator."""

from importlib import import_module
from typing import Any

_HOMES = {
    "run": "api",
    "load": "api",
    "Run": "api",
    "compare": "api",
    "experiment": "api",
    "Experiment": "api",
    "InputError": "errors",
    "Trouble": "errors",
}
__all__ = list(_HOMES)


def __getattr__(name: str) -> Any:
    """Load a public name at its first use, since JAX takes a second to load."""
    if name not in _HOMES:
        raise AttributeError(f"module 'primordia' has no attribute {name!r}")
    return getattr(import_module(f"primordia.{_HOMES[name]}"), name)
