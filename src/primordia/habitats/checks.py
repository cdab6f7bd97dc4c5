"""The checks of a habitat before a run: its properties, and in JAX its shapes and dtypes."""

import traceback
from collections.abc import Callable
from inspect import getsourcefile
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp

from primordia.errors import InputError
from primordia.habitats.contract import (
    Ability,
    Action,
    AnyHabitat,
    Compound,
    Continuous,
    Discrete,
    JaxHabitat,
    Outcome,
)

LARGEST = 2**20
"""Largest number of senses, of random words of a birth, and of outputs of a brain."""
RATES = (1e-6, 1e9)
"""Least and largest number of ticks in a second of simulated time."""
BODIES = 32
"""Number of bodies of a trace."""
FLAGS = ("fatal", "expired", "fault")
"""The results of an Outcome that are bool; the others are float32."""


def check_properties(habitat: AnyHabitat) -> None:
    """Check the properties of a habitat.

    Raises:
        InputError: a property is missing or wrong; the message says which.
    """
    try:
        sizes = {"senses_size": (habitat.senses_size, 1), "words": (habitat.words, 0)}
        action, tallies, rate = habitat.action, habitat.tallies, habitat.rate
    except TypeError as error:  # a property has no default and is missing
        raise InputError(f"habitat: {error}") from None
    for name, (value, least) in sizes.items():
        if type(value) is not int or not least <= value <= LARGEST:
            wanted = f"a whole number from {least} to {LARGEST}"
            raise _fault(habitat, f"has {name} = {value!r}; it must be {wanted}")
    if not _is_action(action):
        wanted = "Discrete(2) or more, Continuous(1) or more, or a Compound of such parts"
        raise _fault(habitat, f"has action = {action!r}; it must be {wanted}")
    if tallies and not habitat.can(Ability.TALLY):
        raise _fault(habitat, "has tallies, so it must be a HostHabitat that defines tally()")
    low, high = RATES
    if rate is not None and not low <= rate <= high:
        wanted = f"{low:g} to {high:g} ticks in a second, or None"
        raise _fault(habitat, f"has the rate {rate!r}; use {wanted}")


def _is_action(action: object) -> bool:
    return (
        isinstance(action, Discrete | Continuous | Compound)
        and len(action.parts) > 0
        and all(isinstance(part, Discrete | Continuous) for part in action.parts)
        and all(part.size > isinstance(part, Discrete) for part in action.parts)
        and action.size <= LARGEST
    )


def check_arrays(habitat: JaxHabitat) -> None:
    """Trace `reset`, `sense` and `step`, and check their results. Nothing is computed.

    Raises:
        InputError: a function fails, or its result does not keep the contract; the message says how.
    """
    words = jax.ShapeDtypeStruct((BODIES, habitat.words), jnp.uint32)
    bodies = _traced(habitat, habitat.reset, words)
    for leaf in jax.tree.leaves(bodies):
        if leaf.shape[:1] != (BODIES,):
            made = f"makes bodies with an array {leaf.dtype} {leaf.shape}"
            raise _fault(habitat, f"{made}; its first axis must be bodies")
    senses = _traced(habitat, habitat.sense, bodies)
    _check(habitat, "senses", senses, (BODIES, habitat.senses_size), jnp.float32)
    stepped = _traced(habitat, habitat.step, bodies, action_shape(habitat.action, BODIES))
    if not isinstance(stepped, tuple) or len(stepped) != 2:
        says = "does not return a pair from step; return bodies and an Outcome"
        raise _fault(habitat, says)
    after, outcome = stepped
    if len({jax.tree.structure(each) for each in (after, bodies)}) > 1:
        made = "makes bodies of different forms in step and in reset"
        raise _fault(habitat, f"{made}; return the same tree of arrays from both")
    for one, other in zip(jax.tree.leaves(after), jax.tree.leaves(bodies), strict=True):
        _check(habitat, "bodies after a step", one, other.shape, other.dtype)
    _check_outcome(habitat, outcome)


def action_shape(action: Action, count: int) -> jax.ShapeDtypeStruct:
    """Return the shape and dtype of the actions of `count` bodies."""
    if isinstance(action, Discrete):
        return jax.ShapeDtypeStruct((count,), jnp.int32)
    columns = action.size if isinstance(action, Continuous) else action.columns
    return jax.ShapeDtypeStruct((count, columns), jnp.float32)


def _traced(habitat: JaxHabitat, function: Callable[..., Any], *arguments: Any) -> Any:
    """Return the shapes that a function gives, in place of arrays."""
    try:
        return jax.eval_shape(function, *arguments)
    except (Exception, SystemExit) as error:  # the habitat may be the user's
        text = (str(error).splitlines() or [""])[0]
        says = f"{type(error).__name__}: {text}".removesuffix(": ")
        where = _line_of(habitat, error)
        raise _fault(habitat, f"fails in {function.__name__}: {says}{where}") from None


def _line_of(habitat: JaxHabitat, error: BaseException) -> str:
    """Return the last line of the habitat's file that an error went through."""
    try:
        file = getsourcefile(type(habitat))
    except TypeError:
        return ""
    frames = traceback.extract_tb(error.__traceback__)
    lines = [each.lineno for each in frames if each.filename == file]
    return f" ({Path(file or '').name}, line {lines[-1]})" if lines else ""


def _check_outcome(habitat: JaxHabitat, outcome: Any) -> None:
    if not isinstance(outcome, Outcome):
        raise _fault(habitat, f"returns {outcome!r} from step; return an Outcome")
    for name, each in outcome._asdict().items():
        if each is not None or name == "fatal":
            dtype = jnp.bool_ if name in FLAGS else jnp.float32
            _check(habitat, f"outcome.{name}", each, (BODIES,), dtype)


def _check(habitat: JaxHabitat, what: str, found: Any, shape: tuple[int, ...], dtype: Any) -> None:
    wanted = f"{jnp.dtype(dtype)} {shape}"
    is_array = isinstance(found, jax.ShapeDtypeStruct)
    given = f"{found.dtype} {tuple(found.shape)}" if is_array else f"{found!r}"
    if given != wanted:
        raise _fault(habitat, f"gives {what} as {given}; the contract says {wanted}")


def _fault(habitat: AnyHabitat, says: str) -> InputError:
    return InputError(f"habitat: {type(habitat).__name__} {says}")
