"""A life lived again, tick for tick: from an organism's genome, its world's seed, and where it was born.

Nothing else enters (the first of the promises), so the neighbours need not live again with it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia import checkpoint
from primordia.brain import Genome, split
from primordia.chunk import named_leaves
from primordia.climate import climate_at
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.genesis import body_words
from primordia.habitats import Bodies, Habitat
from primordia.keys import Purpose, stream
from primordia.law import Law, act
from primordia.lineage import place_in, rebuild
from primordia.lives import Lives, lives
from primordia.metabolism import ONE, Rates, fixed, metabolise
from primordia.report import opened
from primordia.wide import Wide, wide
from primordia.world import Cause

TICKS = 4096
"""Lived in one compiled call."""


class Instant(NamedTuple):
    """Where a life stands; one organism, so the first axis of everything is 1."""

    memory: Array
    energy: Array
    bodies: Bodies


class Stretch(NamedTuple):
    """Some ticks of a life, one after another, first axis n."""

    tick: np.ndarray
    """int64: of the world, at its end"""
    bodies: Bodies
    """as they then are"""
    action: np.ndarray
    """that led there"""
    energy: np.ndarray
    """float64, units; 0 without a metabolism"""
    fatal: np.ndarray
    """bool"""


@dataclass(frozen=True)
class Life:
    """What a life is a function of, and what is recorded of it."""

    run: Path
    config: Config
    law: Law
    habitat: Habitat
    genome: Genome
    """of one"""
    record: Lives
    """of one"""
    begins: int
    """tick from whose end it can be lived again: its birth, or the fork's"""

    @classmethod
    def of(cls, run: Path, organism: int, world: int = 0) -> "Life":
        """An organism's.

        Raises:
            InputError: no such organism was born, or its habitat cannot be lived in again.
        """
        config, _ = opened(run)
        everyone = lives(run)
        row = everyone.row(organism, world)
        habitat = config.build_habitat()
        if hasattr(habitat, "open"):
            raise InputError(f"{run}: a life in a habitat on the host cannot be lived again yet")
        law = config.build_law(habitat)
        genome = split(law.brain, jnp.asarray(rebuild(run, organism, world)[None]))
        record = everyone.take(slice(row, row + 1))
        begins = max(int(record.born[0]), config.origin.tick if config.origin else 0)
        return cls(run, config, law, habitat, genome, record, begins)

    @property
    def world(self) -> int:
        """Where it was lived."""
        return int(self.record.world[0])

    @property
    def ends(self) -> int:
        """The tick of its death, or its world's last so far."""
        return int(self.record.ended[0])

    @property
    def cause(self) -> Cause | None:
        """Of its death, if it died."""
        return Cause(self.record.cause[0]) if self.record.died[0] else None

    def start(self) -> Instant:
        """Where it begins: at birth, or where a fork found it."""
        organism, seed = int(self.record.id[0]), wide([self.config.seed + self.world])
        key = stream(seed, Purpose.BODY, wide(self.record.born))
        bodies = self.habitat.reset(
            body_words(key, jnp.asarray(self.record.cell), self.habitat.words)
        )
        memory = jnp.zeros((1, self.law.brain.memory), jnp.float32)
        if self.begins == self.record.born[0]:
            store = self._rates(np.array([self.begins])).store
            return Instant(memory, fixed(store), bodies)
        origin = checkpoint.origin(self.run)
        assert origin is not None
        arrays, cell = origin.arrays(), [place_in(origin, self.law, organism, self.world)]
        leaves = [jnp.asarray(arrays[name][cell]) for name, _ in named_leaves({"bodies": bodies})]
        return Instant(
            jnp.asarray(arrays["world.organisms.memory"][cell]),
            jnp.asarray(arrays["world.organisms.energy"][cell]),
            jax.tree.unflatten(jax.tree.structure(bodies), leaves),
        )

    def again(self) -> Iterator[Stretch]:
        """All of it, in order, TICKS or fewer at a time.

        Raises:
            Trouble: its death does not come where it is recorded.
        """
        lived = jax.jit(partial(_lived, self.law, self.habitat, self.genome))
        seed, cell = wide([self.config.seed + self.world]), jnp.asarray(self.record.cell)
        instant = self.start()
        for first in range(self.begins, self.ends, TICKS):
            ticks = first + 1 + np.arange(TICKS)
            count = min(TICKS, self.ends - first)
            instant, seen = lived(seed, cell, instant, wide(ticks), self._rates(ticks))
            stretch = Stretch(ticks[:count], *_first(seen, count))
            if not np.array_equal(stretch.fatal, self._dies_in(stretch.tick)):
                raise Trouble(
                    f"{self.run}: organism {self.record.id[0]} did not live again as recorded;"
                    " `primordia verify` tells whether this machine gives the run's bits"
                )
            yield stretch._replace(energy=stretch.energy / ONE)

    def _dies_in(self, ticks: np.ndarray) -> np.ndarray:
        """In which ticks its body is recorded to have met its end."""
        return (ticks == self.ends) & (self.cause is Cause.FATAL)

    @cached_property
    def _climate(self) -> Callable[[np.ndarray], dict[str, np.ndarray]]:
        return climate_at(self.run, self.config, self.law, self.world)

    def _rates(self, ticks: np.ndarray) -> Rates:
        """The metabolism in force, float32 (n,) each."""
        climate = self._climate(ticks)
        return Rates(*(jnp.asarray(climate[f"metabolism.{name}"]) for name in Rates._fields))


def _first(seen: tuple, count: int) -> tuple:
    """What was seen of the one organism in the first ticks, on the host."""
    return jax.tree.map(lambda each: np.asarray(each[:count, 0]), seen)


def _lived(
    law: Law,
    habitat: Habitat,
    genome: Genome,
    seed: Wide,
    cell: Array,
    instant: Instant,
    ticks: Wide,
    rates: Rates,
) -> tuple[Instant, tuple]:
    """One organism's ticks (n,) -> where it then stands; bodies, actions, energies, whether fatal."""

    def step(now: Instant, given: tuple[Wide, Rates]) -> tuple[Instant, tuple]:
        tick, rates = given
        memory, output = law.brain(genome, now.memory, habitat.sense(now.bodies))
        action = act(law, stream(seed, Purpose.MOTOR, tick.map(jnp.atleast_1d)), cell, output)
        bodies, outcome = habitat.step(now.bodies, action)
        energy = now.energy
        if law.metabolism is not None:
            energy = metabolise(energy, outcome.food, outcome.effort, rates)
        return Instant(memory, energy, bodies), (bodies, action, energy, outcome.fatal)

    return lax.scan(step, instant, (ticks, rates))
