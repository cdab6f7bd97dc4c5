"""The state of W worlds of N cells each: arrays over C = W x N cells on one axis, and over worlds.

This state and the habitat's bodies are all that a run needs to go on. The values of an empty cell have no
meaning.
"""

from enum import IntEnum
from typing import NamedTuple, TypeAlias

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Genome
from primordia.law.act import Acts
from primordia.random.wide import Wide, select, total, zero


class Named(IntEnum):
    """Numbers that records and messages show as words."""

    @property
    def label(self) -> str:
        """The word, such as `time-limit`."""
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


class Remembered(NamedTuple):
    """The latest R moments that each organism and its line of descent remember; first axis C."""

    senses: Array
    """float32 (C, R, S)"""
    memory: Array
    """the memory at the same moments, float32 (C, R, M)"""
    known: Array
    """bool (C, R): a moment is stored at this index"""


class Organisms(NamedTuple):
    """The organisms in the cells; first axis C."""

    alive: Array
    """bool"""
    genome: Genome
    """block of weights -> float32 (C, *shape)"""
    notes: Array
    """int32 (C, n); see `Mutation.notes`"""
    memory: Array
    """float32 (C, M)"""
    energy: Array
    """int32, fixed point"""
    eaten: Array
    """food of the organism's life so far, int32, fixed point, saturating"""
    born: Wide
    """tick of birth"""
    number: Wide
    """birth number within its world, from 0"""
    branch: Wide
    """1 + birth number of the founder's child from which the organism descends; 0 for a founder.
    After fixation all the living have the same branch, which is not 0"""
    moments: Remembered | None
    """None if the mutation needs no moments; see `Mutation.moments`"""


Climate: TypeAlias = dict[str, Array]
"""The present values of the settings that seasons may change: dotted name -> float32 (W,)."""


class Looks(NamedTuple):
    """The state of S ratchets, (W, S): their last and next measurements of the worlds."""

    wait: Array
    """int32, ticks until the next measurement"""
    food: Wide
    """the world's food at the last measurement"""
    organism_ticks: Wide
    """the world's organism-ticks at the last measurement"""


class Worlds(NamedTuple):
    """The history of each world so far; first axis W."""

    seed: Wide
    tick: Wide
    """ticks lived"""
    births: Wide
    deaths: Wide
    """(W, causes)"""
    extinctions: Wide
    organism_ticks: Wide
    food: Wide
    """food gathered by all organisms, fixed point, two's complement"""
    calm: Array
    """int32, ticks since the last birth or death, saturating"""
    sample_wait: Array
    """int32, ticks until the next sample"""
    saturated: Wide
    """tick at which the world was first saturated; `wide.never` before that"""
    saturated_births: Wide
    """births until saturation; `wide.never` before that"""
    fixed: Wide
    """tick of fixation, at which all the living first descended from one child of a founder;
    `wide.never` before that, and again after an extinction"""
    fixed_births: Wide
    """births until fixation; `wide.never` before that"""
    climate: Climate
    looks: Looks
    acts: Acts | None
    """None unless replication is an act"""


class World(NamedTuple):
    """The whole state that the law acts on."""

    organisms: Organisms
    worlds: Worlds


def ages(world: World) -> Wide:
    """Return the ticks since the birth of each cell's organism, (C,), 0 in empty cells."""
    organisms, worlds = world
    cells = organisms.alive.size // worlds.calm.size
    now = worlds.tick.map(lambda words: jnp.repeat(words, cells))
    return select(organisms.alive, now - organisms.born, zero(organisms.alive.shape))


def ages_total(world: World) -> Wide:
    """Return the sum of the ages of each world's living, (W,)."""
    return total(ages(world).map(lambda words: words.reshape(world.worlds.calm.size, -1)), axis=1)
