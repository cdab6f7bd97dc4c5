"""The check of a mutation before a run: what it returns for children and for founders."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.layout import Layout
from primordia.mutations.contract import PURPOSES, Draws, Family, Moments, Mutation
from primordia.random.keys import streams
from primordia.random.wide import wide
from primordia.settings.tracing import COUNT, Tracing

MOST_TICKS = 2**16
"""Longest time over which an organism remembers moments, in ticks."""


def check_mutation(mutation: Mutation, layout: Layout) -> None:
    """Call and trace the methods of a mutation. No genome is computed.

    Args:
        mutation: the mutation with its settings.
        layout: layout of the genomes.

    Raises:
        InputError: a method fails, or its result does not keep the contract; the message says how.
    """
    tracing = Tracing("mutation", mutation)
    _check_properties(tracing, mutation)
    size, rates = len(mutation.notes), tracing.called("rates", mutation.rates, layout)
    tracing.need(
        isinstance(rates, dict)
        and all(isinstance(each, float) and np.isfinite(each) for each in rates.values()),
        f"gives rates as {rates!r}; return a dictionary of names and finite floats",
    )
    family = _family(mutation, layout, rates)
    notes = tracing.called("founders_notes", mutation.founders_notes, COUNT)
    tracing.typed("founders' notes", notes, (COUNT, size), jnp.int32)
    noted = tracing.traced("note", partial(_note, mutation, layout), family)
    tracing.typed("notes", noted, (COUNT, size), jnp.int32)
    pair: Any = tracing.traced("inherit", partial(mutation.inherit, layout), family)
    tracing.need(
        isinstance(pair, tuple) and len(pair) == 2,
        "does not return a pair from inherit; return genomes, and which are mutants",
    )
    tracing.typed("genomes of children", pair[0], (COUNT, layout.length), jnp.float32)
    tracing.typed("which children are mutants", pair[1], (COUNT,), jnp.bool_)
    made = tracing.traced("founders", partial(mutation.founders, layout), family.draws)
    tracing.typed("genomes of founders", made, (COUNT, layout.length), jnp.float32)


def _check_properties(tracing: Tracing, mutation: Mutation) -> None:
    notes, moments = mutation.notes, mutation.moments
    tracing.need(
        isinstance(notes, tuple) and all(isinstance(each, str) for each in notes),
        f"has notes = {notes!r}; it must be a tuple of names",
    )
    tracing.need(
        mutation.notes_from in ("parent", "cell"),
        f"has notes_from = {mutation.notes_from!r}; it must be 'parent' or 'cell'",
    )
    fits = moments is None or (
        isinstance(moments, Moments)
        and min(moments) >= 1
        and moments.kept * moments.every <= MOST_TICKS
    )
    tracing.need(
        fits, f"has moments = {moments!r}; it must be None, or Moments of 2^16 ticks or less"
    )


def _family(mutation: Mutation, layout: Layout, rates: dict[str, float]) -> Family:
    """Return shapes and dtypes of births in place of arrays."""
    drawn = Draws(
        streams(wide(np.zeros(COUNT)), wide(np.zeros(COUNT)), *PURPOSES), jnp.arange(COUNT)
    )
    shaped = jax.eval_shape(lambda draws: draws, drawn)
    floats: Any = partial(jax.ShapeDtypeStruct, dtype=jnp.float32)
    notes: Any = jax.ShapeDtypeStruct((COUNT, len(mutation.notes)), jnp.int32)
    each = {name: floats((COUNT,)) for name in rates}
    return Family(floats((COUNT, layout.length)), notes, each, shaped)


def _note(mutation: Mutation, layout: Layout, family: Family) -> Any:
    def unchanged(children: Array) -> Array:
        return jnp.zeros(len(children), jnp.float32)

    return mutation.note(layout, family, None if mutation.moments is None else unchanged)
