"""The state of W worlds of N cells each: arrays over C = W x N cells on one axis, and over worlds.

Everything a run needs to go on is here and in the habitat's bodies. What an empty cell holds has no
meaning.
"""

from enum import IntEnum
from typing import NamedTuple, TypeAlias

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Genome
from primordia.random.wide import Wide, select, total, zero


class Named(IntEnum):
    """Numbers that people read as words."""

    @property
    def label(self) -> str:
        """As in records and messages: `time-limit`."""
        return self.name.lower().replace("_", "-")


class Cause(Named):
    """Cause of a death. Numbers are part of the format."""

    FATAL = 0
    STARVED = 1
    HAZARD = 2
    REPLACED = 3
    FAULT = 4
    TIME_LIMIT = 5
    RESTART = 6


class BirthCause(Named):
    """Cause of a birth. Numbers are part of the format."""

    FOUNDER = 0
    COPY = 1
    MUTANT = 2


class Organisms(NamedTuple):
    """What lives in the cells; first axis C."""

    alive: Array
    """bool"""
    genome: Genome
    """block of weights -> float32 (C, *shape)"""
    notes: Array
    """int32 (C, n): what the mutation keeps with an organism; see `Mutation.notes`"""
    memory: Array
    """float32 (C, M)"""
    energy: Array
    """int32, fixed point"""
    eaten: Array
    """food of its whole life, int32, fixed point, saturating"""
    born: Wide
    """tick of birth"""
    number: Wide
    """birth number within its world, from 0"""
    branch: Wide
    """1 + number of the founder's child it descends from, 0 for a founder: equal in all of the
    living, and not 0, once the population has fixed"""


Climate: TypeAlias = dict[str, Array]
"""The settings that seasons may change, as they stand in each world: dotted name -> float32 (W,)."""


class Looks(NamedTuple):
    """What each ratchet (W, S) remembers between its looks at the world."""

    wait: Array
    """int32, ticks until the next look"""
    food: Wide
    """the world's food, and ..."""
    organism_ticks: Wide
    """... its organism-ticks, at the last look"""


class Worlds(NamedTuple):
    """The history of each world so far; first axis W."""

    seed: Wide
    tick: Wide
    """ticks lived through"""
    births: Wide
    deaths: Wide
    """(W, causes)"""
    extinctions: Wide
    organism_ticks: Wide
    food: Wide
    """gathered by all, fixed point, two's complement"""
    calm: Array
    """int32, ticks since the last birth or death, saturating"""
    sample_wait: Array
    """int32, ticks until the next sample"""
    saturated: Wide
    """tick at which the world was first saturated, and ..."""
    saturated_births: Wide
    """... births until then; `wide.never` before it happens"""
    fixed: Wide
    """tick at which all the living first descended from one organism born after the founder; a
    world that goes extinct begins anew, and ..."""
    fixed_births: Wide
    """... births until then"""
    climate: Climate
    looks: Looks


class World(NamedTuple):
    """All that the law acts on."""

    organisms: Organisms
    worlds: Worlds


def ages(world: World) -> Wide:
    """Ticks since birth of each cell's organism (C,), 0 where nobody lives."""
    organisms, worlds = world
    each = organisms.alive.size // worlds.calm.size
    now = worlds.tick.map(lambda words: jnp.repeat(words, each))
    return select(organisms.alive, now - organisms.born, zero(organisms.alive.shape))


def ages_total(world: World) -> Wide:
    """Sum of the ages of the living of each world (W,)."""
    return total(ages(world).map(lambda words: words.reshape(world.worlds.calm.size, -1)), axis=1)
