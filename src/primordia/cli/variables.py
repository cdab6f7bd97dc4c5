"""Environment variables of JAX, checked before a command that would fail because of them."""

import os

from primordia.errors import InputError

UNUSABLE = {
    "JAX_NO_TRACING": ("1", "true"),
    "JAX_NUMPY_RANK_PROMOTION": ("raise",),
    "JAX_TRANSFER_GUARD": ("disallow", "disallow_explicit"),
}
"""Variables of JAX, and their values that forbid what every run does."""


def check_variables() -> None:
    """Import JAX if a variable of JAX is set; call this before JAX's variables are set for a command.

    Raises:
        InputError: JAX refuses the value of a variable, or no run works with it.
    """
    for name, values in UNUSABLE.items():
        if (value := os.environ.get(name, "")).lower() in values:
            raise InputError(f"no run works with {name}={value}; unset this variable")
    if not any(name.startswith("JAX_") for name in os.environ):
        return
    try:
        import jax  # noqa: F401
    except ValueError as error:
        raise InputError(f"JAX does not start: {error}; correct or unset this variable") from None
