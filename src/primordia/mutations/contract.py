"""The contract of mutations. A mutation makes the genomes of children and of founders.

A mutation is used twice: when an organism is born, and when its genome is rebuilt from the records of its
line of descent. Both give the same bits on any device. So a mutation is made of integer draws, table
look-ups, and float32 products and sums that are each rounded (`noise`).

`kind` in a task's `[mutation]` table is one of the names in `KNOWN`, or `module:Class` of any `Mutation`.
The other keys of the table are the class's own settings.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, Literal, NamedTuple, TypeAlias

import jax.numpy as jnp
from jax import Array

from primordia.brains.layout import Layout
from primordia.random.keys import Purpose, Streams, bits
from primordia.random.wide import Wide
from primordia.settings import parts
from primordia.settings.base import Settings
from primordia.settings.fields import rates_of

KNOWN = {
    "gaussian": "primordia.mutations.gaussian:Gaussian",
    "calibrated": "primordia.mutations.calibrated:Calibrated",
    "heritable": "primordia.mutations.heritable:Heritable",
}

PURPOSES = Purpose.MUTATE, Purpose.NOISE, Purpose.FOUNDER
"""The purposes for which a mutation may draw random bits: which births mutate, what a mutation
changes, and founders. A neutral shadow draws all but the first again."""


class Draws(NamedTuple):
    """Random words of K births; they depend on world, tick and cell of a birth, and on nothing else."""

    streams: Streams
    """keys for each purpose in PURPOSES, (K,)"""
    cell: Array
    """cell of each birth within its world, int32 (K,)"""

    def bits(self, purpose: Purpose, index: Array | int = 0) -> Wide:
        """Return two random words for each birth, (K,); each `index` gives a separate draw."""
        return bits(self.streams[purpose], self.cell, index)


class Family(NamedTuple):
    """The inputs from which the genomes of K children are made."""

    parents: Array
    """genomes of the parents, float32 (K, P)"""
    notes: Array
    """int32 (K, n): notes of the parents for `Mutation.note`, of the children for `Mutation.inherit`"""
    rates: Mapping[str, Array]
    """present values of the mutation's rates, float32 (K,) each"""
    draws: Draws
    """random words of the births"""

    def take(self, rows: Any) -> "Family":
        """Return the families of some children."""
        rates = {name: values[rows] for name, values in self.rates.items()}
        draws = Draws(self.draws.streams.take(rows), self.draws.cell[rows])
        return Family(self.parents[rows], self.notes[rows], rates, draws)


class Moments(NamedTuple):
    """The number and interval of the moments that organisms remember; a moment is senses and memory."""

    kept: int
    """number of moments; they are the latest of a line of descent, since a child begins with the
    parent's moments"""
    every: int
    """ticks between two moments; multiplied by `kept`, it is at most 2^16"""


Change: TypeAlias = Callable[[Array], Array]
"""A function of K genomes: their change of behaviour in the parents' moments (`Mutation.moments`),
float32 (K,) from (K, P)."""


class Mutation(Settings, ABC):
    """A mutation's settings and its behaviour.

    Seasons may change settings that are declared as `Rate`. Methods get the present values of these
    settings in `Family.rates`, under the names that the method `rates` returns. The first axis of
    all arrays is the births, K. Births do not depend on each other.
    """

    notes: ClassVar[tuple[str, ...]] = ()
    """Names of the notes: small integers that an organism has in addition to its genome, such as a
    heritable rate. The method `note` makes the child's notes from the parent's. Notes are columns of the
    births table."""

    @property
    def moments(self) -> Moments | None:
        """Return the moments that organisms remember for `note`; None if `note` needs none."""
        return None

    @property
    def notes_from(self) -> Literal["parent", "cell"]:
        """Return the organism whose notes `note` gets: the parent, or the last one born in the cell."""
        return "parent"

    def rates(self, layout: Layout) -> dict[str, float]:
        """Return the numbers that seasons may change, by name, with their values at the beginning."""
        return rates_of(self)

    def governed(self, setting: str, layout: Layout) -> list[str]:
        """Return the names among `rates` whose values change if a season changes a setting; [] for
        an unknown setting."""
        return [setting] if setting in self.rates(layout) else []

    def check(self, layout: Layout) -> None:
        """Raise ValueError if the settings do not fit genomes of this layout."""

    def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
        """Return the notes of K children, int32 (K, n), before their genomes are made.

        Args:
            layout: layout of the genomes.
            family: the parents, with their notes.
            change: the change of behaviour; None if organisms remember no `moments`.
        """
        return family.notes

    @abstractmethod
    def inherit(self, layout: Layout, family: Family) -> tuple[Array, Array]:
        """Make the genomes of K children.

        Args:
            layout: layout of the genomes.
            family: the parents, with the notes of the children.

        Returns:
            genomes, float32 (K, P); mutants, bool (K,): false for an exact copy.
        """

    @abstractmethod
    def founders(self, layout: Layout, draws: Draws) -> Array:
        """Make the genomes of K founders, float32 (K, P)."""

    def founders_notes(self, count: int) -> Array:
        """Return the notes of K founders, int32 (K, n)."""
        return jnp.zeros((count, len(self.notes)), jnp.int32)


def find(name: object) -> type[Mutation]:
    """Return the mutation class called `name`; raise LookupError, with the reason, if there is none."""
    return parts.find("mutation", name, KNOWN, Mutation)
