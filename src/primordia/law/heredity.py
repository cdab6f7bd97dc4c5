"""Heredity: the genomes of the newborn, made from parents, ancestors or nothing.

Births use `make_newborn`. A genome is rebuilt from its line of descent by `rebuild_genomes`. Both use
`_genomes`, so they cannot differ. Heredity knows no habitat and no brain, so genomes can be rebuilt
without a habitat or a brain.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.brains.layout import Layout
from primordia.law.recombination import Recombination
from primordia.mutations.contract import PURPOSES, Change, Draws, Family, Mutation
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
    """bool (K,): the newborn is a founder"""
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


@dataclass(frozen=True, eq=False)
class Heredity:
    """The part of the law by which genomes are made."""

    layout: Layout
    """layout of genomes"""
    mutation: Mutation
    recombination: Recombination | None
    inheritance: Literal["parent", "founder"]
    ancestors: np.ndarray | None
    """genomes that founders take in turn, float32 (K, P); None: founders are random"""
    worlds: int
    """number of worlds whose newborn are made together"""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Heredity) and self._content() == other._content()

    def __hash__(self) -> int:
        return hash(self._content())

    def _content(self) -> tuple:
        """Return the values that decide equality. Arrays have no hash, so ancestors are compared by
        bytes."""
        of = self.ancestors
        ancestors = None if of is None else (of.shape, of.dtype.str, of.tobytes())
        parts = self.layout, self.mutation, self.recombination
        return *parts, self.inheritance, ancestors, self.worlds

    @property
    def purposes(self) -> tuple[Purpose, ...]:
        """The purposes for which births draw random bits."""
        return PURPOSES if self.recombination is None else (*PURPOSES, Purpose.CROSS)

    def rates(self, climate: Mapping[str, Array]) -> dict[str, Array]:
        """Return the mutation's rates in a climate, by the names that `Mutation.rates` gives them."""
        return {name: climate[f"mutation.{name}"] for name in self.mutation.rates(self.layout)}

    def recombined(self, birth: Birth, parents: Array, mates: Array, mated: Array) -> Array:
        """Return the genomes that K newborn inherit before mutation, float32 (K, P).

        Args:
            birth: the births.
            parents: genomes of the parents, float32 (K, P).
            mates: genomes of the mates, float32 (K, P).
            mated: which newborn have a mate, bool (K,).
        """
        if self.recombination is None:
            return parents
        both = self.recombination.recombined(self.layout, birth.draws, parents, mates)
        return jnp.where(mated[:, None], both, parents)

    def make_newborn(
        self, birth: Birth, parents: Array, notes: Array, change: Change | None
    ) -> Newborn:
        """Make K newborn from the genomes and notes of their parents, float32 (K, P) and int32 (K, n).

        `change` is passed to `Mutation.note`; it is None if the mutation needs no moments.
        """
        mutation = self.mutation
        if mutation.notes:
            family = Family(parents, notes, birth.rates, birth.draws)
            children = mutation.note(self.layout, family, change)
            founders = mutation.founders_notes(len(notes))
            notes = jnp.where(birth.founder[:, None], founders, children)
        genome, mutated = self._genomes(birth, parents, notes)
        return Newborn(genome, notes, mutated)

    def rebuild_genomes(self, birth: Birth, parents: Array, notes: Array) -> Array:
        """Return the genomes (K, P) of recorded births from their recorded notes (K, n)."""
        return self._genomes(birth, parents, notes)[0]

    def _genomes(self, birth: Birth, parents: Array, notes: Array) -> tuple[Array, Array]:
        if self.inheritance == "founder":
            return self._founders(birth), jnp.zeros_like(birth.founder)
        birth = birth._replace(draws=_one_noise(birth))
        family = Family(parents, notes, birth.rates, birth.draws)
        children, mutated = self.mutation.inherit(self.layout, family)

        def with_founders() -> Array:
            return jnp.where(birth.founder[:, None], self._founders(birth), children)

        if self.worlds == 1:
            return with_founders(), mutated & ~birth.founder
        # In 16 worlds of 32 cells this branch halves the time of a tick. In one world it would add
        # a tenth, since the results of a branch are stored.
        genome = lax.cond(birth.founder.any(), with_founders, lambda: children)
        return genome, mutated & ~birth.founder

    def _founders(self, birth: Birth) -> Array:
        """Make random genomes, or take the ancestors' genomes in turn from a start that differs by
        world."""
        if self.ancestors is None:
            return self.mutation.founders(self.layout, birth.draws)
        return jnp.asarray(self.ancestors)[modulo(birth.seed + birth.number, len(self.ancestors))]


def _one_noise(birth: Birth) -> Draws:
    """Return draws with one stream of noise for each newborn: a founder's, or a child's.

    No newborn needs both streams. Drawing both took a tenth of the time of a world with many
    births.
    """
    streams, cell = birth.draws
    noise = select(birth.founder, streams[Purpose.FOUNDER], streams[Purpose.NOISE])
    return Draws(streams.replaced(noise, Purpose.FOUNDER, Purpose.NOISE), cell)
