"""Environment variables of JAX, checked before a command that would fail because of them."""

import os

from primordia.errors import InputError


def check_variables() -> None:
    """Import JAX if a variable of JAX is set; call this before JAX's variables are set for a command.

    Raises:
        InputError: JAX refuses the value of a variable.
    """
    if not any(name.startswith("JAX_") for name in os.environ):
        return
    try:
        import jax  # noqa: F401
    except ValueError as error:
        raise InputError(f"JAX does not start: {error}; correct or unset this variable") from None
