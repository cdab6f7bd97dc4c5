"""Invented births, and mutations compiled as the engine compiles them."""

from collections.abc import Callable

import numpy as np
from jax import Array

from primordia.brains.layout import Layout
from primordia.compiled import shared
from primordia.mutations.contract import PURPOSES, Change, Draws, Family, Mutation
from primordia.random.keys import streams
from primordia.random.wide import wide


def drawn(count: int) -> Draws:
    """Return the draws of births in cells 0, 1, 2 ... of worlds with the seeds 0, 1, 2 ..."""
    number = np.arange(count)
    return Draws(streams(wide(number), wide(np.zeros(count)), *PURPOSES), number.astype(np.int32))


def rates(mutation: Mutation, layout: Layout, count: int, **own: float) -> dict[str, np.ndarray]:
    values = {**mutation.rates(layout), **own}
    return {name: np.full(count, value, np.float32) for name, value in values.items()}


def inherited(mutation: Mutation, layout: Layout, of: Family) -> tuple[np.ndarray, np.ndarray]:
    """Return the genomes of children, and which of them are mutants."""
    genomes, mutants = shared(type(mutation).inherit, mutation, layout)(of)
    return np.asarray(genomes), np.asarray(mutants)


def noted(
    mutation: Mutation, layout: Layout, of: Family, kind: Callable[[Array], Change] | None = None
) -> np.ndarray:
    """Return the only note of each child; `kind` makes the change of behaviour from the parents."""
    return np.asarray(shared(_note, mutation, layout, kind)(of))[:, 0]


def _note(mutation: Mutation, layout: Layout, kind: Callable | None, of: Family) -> Array:
    return mutation.note(layout, of, None if kind is None else kind(of.parents))
