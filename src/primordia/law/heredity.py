"""Heredity: the genomes of the newborn, made from parents, ancestors or nothing.

Births use `make_newborn`. A genome is rebuilt from its line of descent by `rebuild_genomes`. Both use
`_genomes`, so they cannot differ.
"""

from collections.abc import Mapping
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array, lax

from primordia.law.law import Law
from primordia.mutations.contract import Draws
from primordia.random.keys import Purpose
from primordia.random.wide import Wide, modulo, select


class Birth(NamedTuple):
    """Everything that the genomes of K newborn depend on, except their parents' genomes and notes."""

    seed: Wide
    """seed of the world, (K,)"""
    number: Wide
    """birth number within the world, (K,)"""
    draws: Draws
    founder: Array
    """bool (K,): it inherits nothing from a parent"""
    rates: Mapping[str, Array]
    """the mutation's rates in the world, float32 (K,) each"""


class Newborn(NamedTuple):
    """Genomes of K newborn."""

    genome: Array
    """float32 (K, P)"""
    notes: Array
    """int32 (K, n); see `Mutation.notes`"""
    mutated: Array
    """bool (K,)"""


def mutation_rates(law: Law, climate: Mapping[str, Array]) -> dict[str, Array]:
    """Return the mutation's rates in a climate, by the names that `Mutation.rates` gives them."""
    names = law.mutation.rates(law.layout)
    return {name: climate[f"mutation.{name}"] for name in names}


def make_newborn(law: Law, birth: Birth, parents: Array, notes: Array) -> Newborn:
    """Make K newborn from their parents' genomes float32 (K, P) and notes int32 (K, n)."""
    mutation = law.mutation
    if mutation.notes:
        children = mutation.note(law.layout, parents, notes, birth.rates, birth.draws)
        founders = mutation.founders_notes(len(notes))
        notes = jnp.where(birth.founder[:, None], founders, children)
    genome, mutated = _genomes(law, birth, parents, notes)
    return Newborn(genome, notes, mutated)


def rebuild_genomes(law: Law, birth: Birth, parents: Array, notes: Array) -> Array:
    """Return the genomes (K, P) of recorded births, whose recorded notes are (K, n)."""
    return _genomes(law, birth, parents, notes)[0]


def _genomes(law: Law, birth: Birth, parents: Array, notes: Array) -> tuple[Array, Array]:
    if law.inheritance == "founder":
        return _founders(law, birth), jnp.zeros_like(birth.founder)
    birth = birth._replace(draws=_one_noise(birth))
    children, mutated = law.mutation.inherit(law.layout, parents, notes, birth.rates, birth.draws)

    def with_founders() -> Array:
        return jnp.where(birth.founder[:, None], _founders(law, birth), children)

    if law.worlds == 1:
        return with_founders(), mutated & ~birth.founder
    # What leaves a branch is stored. In 16 worlds of 32 cells that halves the time of a tick; in one
    # world it would add a tenth.
    genome = lax.cond(birth.founder.any(), with_founders, lambda: children)
    return genome, mutated & ~birth.founder


def _founders(law: Law, birth: Birth) -> Array:
    """Make random genomes, or take ancestors' in turn, beginning with another one in each world."""
    if law.ancestors is None:
        return law.mutation.founders(law.layout, birth.draws)
    return jnp.asarray(law.ancestors)[modulo(birth.seed + birth.number, len(law.ancestors))]


def _one_noise(birth: Birth) -> Draws:
    """Return draws in which noise has one stream: a founder's own, or a child's.

    No newborn needs both, so one noise is drawn for each: drawing both took a tenth of the time of a
    world with many births.
    """
    streams, cell = birth.draws
    noise = select(birth.founder, streams[Purpose.FOUNDER], streams[Purpose.NOISE])
    return Draws(streams.replaced(noise, Purpose.FOUNDER, Purpose.NOISE), cell)
