"""Heredity: the genomes of the newborn, from parents, ancestors or nothing.

Births use `newborn`, and rebuilding a genome from its line of descent uses `reborn`; both come down to
`_genomes`, so they cannot differ.
"""

from collections.abc import Mapping
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array, lax

from primordia.law.law import Law
from primordia.mutations.contract import Draws
from primordia.random.wide import Wide, modulo


class Birth(NamedTuple):
    """What the genomes of K newborn depend on, beside their parents' genomes."""

    seed: Wide
    """of the world, (K,)"""
    number: Wide
    """birth number, (K,)"""
    draws: Draws
    founder: Array
    """bool (K,): it inherits nothing from a parent"""
    rates: Mapping[str, Array]
    """float32 (K,) each: the mutation's rates in the world"""


class Newborn(NamedTuple):
    """Genomes of K newborn."""

    genome: Array
    """float32 (K, P)"""
    notes: Array
    """int32 (K, n); see `Mutation.notes`"""
    mutated: Array
    """bool (K,)"""


def mutation_rates(law: Law, climate: Mapping[str, Array]) -> dict[str, Array]:
    """Return the settings of a climate that belong to the mutation, by the names it knows."""
    names = law.mutation.rates(law.layout)
    return {name: climate[f"mutation.{name}"] for name in names}


def newborn(law: Law, birth: Birth, parents: Array, notes: Array) -> Newborn:
    """Make K newborn from their parents' genomes float32 (K, P) and notes int32 (K, n)."""
    mutation = law.mutation
    if mutation.notes:
        own = mutation.note(law.layout, parents, notes, birth.rates, birth.draws)
        founders = mutation.founders_notes(len(notes))
        notes = jnp.where(birth.founder[:, None], founders, own)
    genome, mutated = _genomes(law, birth, parents, notes)
    return Newborn(genome, notes, mutated)


def reborn(law: Law, birth: Birth, parents: Array, notes: Array) -> Array:
    """Make the genomes (K, P) of organisms again, with their own notes (K, n) as recorded."""
    return _genomes(law, birth, parents, notes)[0]


def _genomes(law: Law, birth: Birth, parents: Array, notes: Array) -> tuple[Array, Array]:
    if law.inheritance == "founder":
        return _founders(law, birth), jnp.zeros_like(birth.founder)
    children, mutated = law.mutation.inherit(law.layout, parents, notes, birth.rates, birth.draws)
    # Founders are rare: their genomes are made only when there are some.
    genome = lax.cond(
        birth.founder.any(),
        lambda: jnp.where(birth.founder[:, None], _founders(law, birth), children),
        lambda: children,
    )
    return genome, mutated & ~birth.founder


def _founders(law: Law, birth: Birth) -> Array:
    """Make genomes from nothing, or take ancestors' in turn; worlds begin with different ones."""
    if law.ancestors is None:
        return law.mutation.found(law.layout, birth.draws)
    return jnp.asarray(law.ancestors)[modulo(birth.seed + birth.number, len(law.ancestors))]
