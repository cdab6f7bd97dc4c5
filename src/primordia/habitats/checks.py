"""The checks of a habitat before a run: its properties, and in JAX its shapes and dtypes."""

from collections.abc import Iterable
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
from primordia.settings.tables import did_you_mean
from primordia.settings.tracing import COUNT, Tracing

LARGEST = 2**20
"""Largest number of senses, of random words of a birth, and of outputs of a brain."""
RATES = (1e-6, 1e9)
"""Least and largest number of ticks in a second of simulated time."""
FLAGS = ("fatal", "expired", "fault")
"""The results of an Outcome that are bool; the others are float32."""


def check_properties(habitat: AnyHabitat) -> None:
    """Check the properties of a habitat.

    Raises:
        InputError: a property is missing or wrong; the message says which.
    """
    tracing = Tracing("habitat", habitat)
    try:
        sizes = {"senses_size": (habitat.senses_size, 1), "words": (habitat.words, 0)}
        action = habitat.action
    except TypeError as error:  # a property has no default and is missing
        raise InputError(f"habitat: {error}") from None
    for name, (value, least) in sizes.items():
        tracing.need(
            type(value) is int and least <= value <= LARGEST,
            f"has {name} = {value!r}; it must be a whole number from {least} to {LARGEST}",
        )
    tracing.need(
        _is_action(action),
        f"has action = {action!r}; it must be Discrete(2) or more, Continuous(1) or more, or a"
        " Compound of such parts",
    )
    _check_options(tracing, habitat)


def _check_options(tracing: Tracing, habitat: AnyHabitat) -> None:
    """Check the properties that have defaults."""
    versions, tallies, rate = habitat.versions, habitat.tallies, habitat.rate
    tracing.need(
        isinstance(versions, dict)
        and all(isinstance(each, str) for pair in versions.items() for each in pair),
        f"has versions = {versions!r}; names and versions must be strings",
    )
    tracing.need(
        isinstance(tallies, tuple) and all(isinstance(each, str) for each in tallies),
        f"has tallies = {tallies!r}; it must be a tuple of names",
    )
    tracing.need(
        not tallies or habitat.can(Ability.TALLY),
        "has tallies, so it must be a HostHabitat that defines tally()",
    )
    if (buttons := habitat.buttons) is not None:
        size = habitat.action.size
        tracing.need(
            len({*buttons}) == len(buttons) == size,
            f"has buttons = {buttons!r}; give each of the {size} choices a name of its own",
        )
    low, high = RATES
    tracing.need(
        rate is None or (isinstance(rate, int | float) and low <= rate <= high),
        f"has the rate {rate!r}; use {low:g} to {high:g} ticks in a second, or None",
    )


def check_parameters(habitat: AnyHabitat, where: str = "", names: Iterable[str] = ()) -> None:
    """Check the physical parameters that a habitat offers, and that it offers those in `names`.

    Args:
        habitat: the habitat.
        where: the setting that names parameters, for the message.
        names: the parameters that it names.

    Raises:
        InputError: the habitat offers something else than names, cannot scale what it offers, or does
            not offer one of `names`.
    """
    tracing, parameters = Tracing("habitat", habitat), habitat.parameters
    tracing.need(
        isinstance(parameters, tuple) and all(isinstance(each, str) for each in parameters),
        f"has parameters = {parameters!r}; it must be a tuple of names",
    )
    needed = ", ".join(habitat.abilities[Ability.SCALE])
    tracing.need(
        not parameters or habitat.can(Ability.SCALE),
        f"has parameters that may change, so it must define {needed}()",
    )
    for name in names:
        if name not in parameters:
            near = did_you_mean(name, [*parameters])
            has = (
                f"known: {', '.join(parameters)}"
                if parameters
                else "this habitat has none, so leave it out"
            )
            raise InputError(f"{where}: there is no physical parameter {name!r}{near}; {has}")


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
    tracing = Tracing("habitat", habitat)
    words = jax.ShapeDtypeStruct((COUNT, habitat.words), jnp.uint32)
    bodies = tracing.traced("reset", habitat.reset, words)
    for leaf in jax.tree.leaves(bodies):
        made = f"makes bodies with an array {leaf.dtype} {leaf.shape}"
        tracing.need(leaf.shape[:1] == (COUNT,), f"{made}; its first axis must be bodies")
    senses = tracing.traced("sense", habitat.sense, bodies)
    tracing.typed("senses", senses, (COUNT, habitat.senses_size), jnp.float32)
    stepped = tracing.traced("step", habitat.step, bodies, _shape_of(habitat.action))
    tracing.need(
        isinstance(stepped, tuple) and len(stepped) == 2,
        "does not return a pair from step; return bodies and an Outcome",
    )
    after, outcome = stepped
    tracing.need(
        len({jax.tree.structure(each) for each in (after, bodies)}) == 1,
        "makes bodies of different forms in step and in reset; return the same tree of arrays from"
        " both",
    )
    for one, other in zip(jax.tree.leaves(after), jax.tree.leaves(bodies), strict=True):
        tracing.typed("bodies after a step", one, other.shape, other.dtype)
    check_outcome(tracing, outcome, COUNT)


def _shape_of(action: Action) -> jax.ShapeDtypeStruct:
    """Return the shape and dtype of actions."""
    if isinstance(action, Discrete):
        return jax.ShapeDtypeStruct((COUNT,), jnp.int32)
    columns = action.size if isinstance(action, Continuous) else action.columns
    return jax.ShapeDtypeStruct((COUNT, columns), jnp.float32)


def check_outcome(tracing: Tracing, outcome: Any, count: int) -> None:
    """Check that a step reports an Outcome of `count` bodies."""
    tracing.need(isinstance(outcome, Outcome), f"returns {outcome!r} from step; return an Outcome")
    for name, each in outcome._asdict().items():
        if each is not None or name == "fatal":
            dtype = jnp.bool_ if name in FLAGS else jnp.float32
            tracing.typed(f"outcome.{name}", each, (count,), dtype)
