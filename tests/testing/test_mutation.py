"""Checks of mutations: what keeps its contract passes, and each fault is caught and named."""

from collections.abc import Mapping
from typing import Any, ClassVar

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.brains.layout import Layout
from primordia.mutations import contract as mutations
from primordia.mutations.contract import Change, Draws, Family, Mutation
from primordia.mutations.gaussian import Block, Gaussian
from primordia.random.keys import Purpose
from primordia.settings.base import Rate
from primordia.testing import ContractError, check_mutation
from tests.testing.impure import counted


@pytest.mark.slow  # tests of these mutations do the same with other settings
@pytest.mark.parametrize("name", mutations.KNOWN)
def test_mutations_that_keep_their_contract(name: str) -> None:
    check_mutation(mutations.find(name)())


def test_a_mutation_must_say_how_it_makes_children_and_founders() -> None:
    assert Mutation.__abstractmethods__ == {"inherit", "founders"}


@pytest.mark.slow
def test_a_mutation_with_settings_for_the_blocks_of_a_layout() -> None:
    """It is the Gaussian one, whose contract is checked with settings for some blocks and for all."""
    mutation = Gaussian(probability=0.4, blocks={"slide-2": Block(scale=0.3)})
    check_mutation(mutation, Layout((("slide-2", (3, 2)), ("0", (2,)))))
    with pytest.raises(ContractError, match=r"no block 'slide-2'.*; give check_mutation a layout"):
        check_mutation(mutation)


def noise_of(draws: Draws, purpose: Purpose, length: int) -> Array:
    """Return numbers from 0 to 1 that depend on the draws; true noise would take longer to compile."""
    seed = draws.streams[purpose].lo + draws.cell.astype(jnp.uint32) * np.uint32(0x9E3779B1)
    mixed = seed[:, None] * (2 * jnp.arange(length, dtype=jnp.uint32) + 1)
    return (mixed >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)


class Steady(Mutation):
    """Noise on all weights of every child."""

    scale: Rate = 0.5

    def inherit(self, layout: Layout, family: Family) -> tuple[Array, Array]:
        parents, _, rates, draws = family
        noise = noise_of(draws, Purpose.NOISE, layout.length)
        change = noise * self.size(rates)[:, None]
        return self.added(parents, change), jnp.ones(len(parents), bool)

    def size(self, rates: Mapping[str, Array]) -> Array:
        return rates["scale"]

    def added(self, parents: Array, change: Array) -> Array:
        return parents + change

    def founders(self, layout: Layout, draws: Draws) -> Array:
        return noise_of(draws, Purpose.FOUNDER, layout.length)


class Sociable(Steady):
    def added(self, parents: Array, change: Array) -> Array:
        return parents + change - change.mean(axis=0)


class Deaf(Steady):
    def size(self, rates: Mapping[str, Array]) -> Array:
        return jnp.full_like(rates["scale"], self.scale)


class Random(Steady):
    def added(self, parents: Array, change: Array) -> Array:
        return parents + change + counted()


class Cleaner(Steady):
    """Its copies are of what is finite only."""

    def inherit(self, layout: Layout, family: Family) -> tuple[Array, Array]:
        finite = jnp.nan_to_num(family.parents) + 0 * family.rates["scale"][:, None]
        return finite, jnp.zeros(len(finite), bool)


class Counted(Steady):
    """With a note; each of the further ones has one fault in it."""

    notes: ClassVar = ("steps",)

    def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
        return family.notes + 1


class Contracted(Counted):
    def added(self, parents: Array, change: Array) -> Array:
        return parents + change * np.float32(0.3)


class Timed(Counted):
    notes: ClassVar = ("tick",)


class Spaced(Counted):
    notes: ClassVar = ("two words",)


class Worldly(Counted):
    notes: ClassVar = ("steps", "world")


class Clustered(Steady):
    def founders(self, layout: Layout, draws: Draws) -> Array:
        founders = super().founders(layout, draws)
        return founders - founders.mean(axis=0)


class Real(Counted):
    def note(self, *given: Any) -> Array:
        return super().note(*given) * 0.5


class Ranked(Counted):
    def founders_notes(self, count: int) -> Array:
        return jnp.arange(count, dtype=jnp.int32)[:, None]


class Open(Steady):
    def governed(self, setting: str, layout: Layout) -> list[str]:
        return ["scale"]


class Closed(Steady):
    def governed(self, setting: str, layout: Layout) -> list[str]:
        return []


class Elsewhere(Steady):
    def governed(self, setting: str, layout: Layout) -> list[str]:
        return [setting, "size"]


class Misled(Steady):
    """A mutation with a setting whose season changes a rate that the mutation does not have."""

    size_of_blocks: Rate = 1.0

    def rates(self, layout: Layout) -> dict[str, float]:
        return {"scale": self.scale}

    def governed(self, setting: str, layout: Layout) -> list[str]:
        return {"scale": ["scale"], "size_of_blocks": ["size"]}.get(setting, [])


def test_products_that_are_added_are_no_fault() -> None:
    check_mutation(Contracted())


@pytest.mark.parametrize(
    ("mutation", "says"),
    [
        (Sociable(), "when 1 instead of 32 are born together; compute each birth alone"),
        (Deaf(), "the same children for all rates; read rates from `rates`"),
        (Random(), "when it is traced again, .*; draw only from `draws`"),
        (Cleaner(), "although it is marked as a copy"),
        (Timed(), "has the note 'tick', which cannot be a column of births; use a name other than"),
        (Spaced(), "has the note 'two words', which cannot be a column of births"),
        (Worldly(), "has the note 'world', which cannot be a column of births"),
        (Clustered(), "organism 31 when 1 instead of 32 are born together"),
        (Real(), r"gives notes as float32 \(32, 1\); the contract says int32 \(32, 1\)"),
        (Ranked(), "gives founders different notes"),
        (Open(), "a season of a setting that the mutation does not have; return"),
        (Closed(), "has a rate scale that no season of scale changes"),
        (Elsewhere(), "a season of .* changes .*size.*, which `rates` lacks"),
        (Misled(), "a season of size_of_blocks changes size, which `rates` lacks"),
    ],
    ids=lambda each: type(each).__name__ if isinstance(each, Mutation) else "",
)
def test_a_mutation_with_a_fault(mutation: Mutation, says: str) -> None:
    with pytest.raises(ContractError, match=says):
        check_mutation(mutation)
