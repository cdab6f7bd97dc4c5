"""A life lived again, tick for tick.

It is a function of the organism's genome, the world's seed, and the tick and cell of birth (the first
promise), so the neighbours need not live again.
"""

from collections.abc import Generator
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property

import jax
import jax.numpy as jnp
import numpy as np
import pyarrow.compute as pc
from jax import Array

from primordia.brains.contract import Genome
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.habitats.contract import AnyHabitat
from primordia.history.births import place_in
from primordia.history.climate import PastClimate
from primordia.history.lineage import rebuild
from primordia.law.genesis import body_words
from primordia.law.law import Law
from primordia.law.life import BODILY, Vitals
from primordia.law.metabolism import ONE, Rates, to_fixed_point
from primordia.law.world import Cause
from primordia.organism.mind import Mind
from primordia.organism.reliving.in_jax import LifeInJax
from primordia.organism.reliving.instant import Instant, Stretch
from primordia.organism.reliving.on_host import LifeOnHost
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide
from primordia.runs.lives import Lives
from primordia.runs.records import Records


@dataclass(frozen=True)
class RelivedLife:
    """The inputs of a life, and its record."""

    run: Records
    config: Config
    law: Law
    habitat: AnyHabitat
    """the habitat that draws pictures; each time the life is lived, it gets a new habitat"""
    genome: Genome
    """a single genome, first axis 1"""
    record: Lives
    """a single row"""

    @classmethod
    def of(cls, run: Records, organism: int, world: int = 0) -> "RelivedLife":
        """Prepare the life of an organism.

        Raises:
            InputError: no such organism was born, or its life cannot be lived again.
        """
        habitat, law, row = run.habitat, run.law, run.lives.row(organism, world)
        genome = law.heredity.layout.split(jnp.asarray(rebuild(run, organism, world)[None]))
        record = run.lives.take(np.array([row]))
        life = cls(run, run.config, law, habitat, genome, record)
        if life.begins_at_fork and not habitat.exact:
            raise InputError(
                f"{run.path}: organism {organism} is older than the fork, and its habitat cannot save"
                " bodies"
            )
        return life

    @property
    def world(self) -> int:
        """The number of the organism's world."""
        return int(self.record.world[0])

    @property
    def begins_at_fork(self) -> bool:
        """Whether the organism was alive at the fork, so that its life is relived from there."""
        fork = self.config.fork
        return fork is not None and int(self.record.born[0]) <= fork.tick

    @property
    def begins(self) -> int:
        """The tick at whose end the relived life begins: that of the birth, or of the fork."""
        fork = self.config.fork
        return max(int(self.record.born[0]), fork.tick if fork else 0)

    @property
    def ends(self) -> int:
        """The tick of death, or the world's last tick so far."""
        return int(self.record.ended[0])

    @property
    def cause(self) -> Cause | None:
        """The cause of death; None if the organism is alive."""
        return Cause(self.record.cause[0]) if self.record.died[0] else None

    def stretches(self, watched: bool = False) -> Generator[Stretch, None, None]:
        """Live the whole life in order, and yield it some ticks at a time.

        Args:
            watched: whether pictures are needed, which a habitat on the host then makes.

        Raises:
            Trouble: the life does not repeat as recorded.
        """
        with closing(self._alone(watched)) as alone:
            instant = self._start(alone)
            for first in range(self.begins, self.ends, alone.TICKS):
                ticks = first + 1 + np.arange(alone.TICKS)
                count = min(alone.TICKS, self.ends - first)
                instant, stretch = alone.live(instant, ticks, self._rates(ticks), count)
                self._check(stretch)
                yield stretch

    def _alone(self, watched: bool) -> LifeInJax | LifeOnHost:
        """Return what steps brain and body, in a new habitat."""
        mind = Mind(self.genome, self._seed, jnp.asarray(self.record.cell))
        habitat = self.config.build_habitat()
        if habitat.kind == "host":
            return LifeOnHost(self.law, mind, habitat, watched)
        return LifeInJax(self.law, mind, habitat)

    def _start(self, alone: LifeInJax | LifeOnHost) -> Instant:
        """Return the state in which the relived life begins: at birth, or at the fork."""
        if self.begins_at_fork:
            return self._at_fork(alone)
        key = stream(self._seed, Purpose.BODY, wide(self.record.born))
        words = body_words(key, jnp.asarray(self.record.cell), self.habitat.words)
        memory = jnp.zeros((1, self.law.memory), jnp.float32)
        store = self._rates(np.array([self.begins])).store
        vitals = Vitals(to_fixed_point(store), jnp.zeros(1, jnp.int32))
        return Instant(memory, vitals, alone.embody(words))

    def _at_fork(self, alone: LifeInJax | LifeOnHost) -> Instant:
        arrays = self.run.origin
        assert arrays is not None
        cell = [place_in(arrays, int(self.record.id[0]), self.world)]

        def own(name: str) -> Array:
            return jnp.asarray(arrays[f"world.organisms.{name}"][cell])

        bodies = {name: array[cell] for name, array in arrays.items() if name.startswith("bodies")}
        vitals = Vitals(own("energy"), own("eaten"))
        return Instant(own("memory"), vitals, alone.restore(bodies))

    def _check(self, stretch: Stretch) -> None:
        """Compare a stretch with the record: tick and cause of death, energy left, food eaten.

        Deaths by neighbours or by chance are not repeated: the organism is then alive at its last tick.
        """
        last = stretch.tick == self.ends
        expected = np.where(last & (self.cause in BODILY), int(self.cause or 0), -1)
        same = np.array_equal(stretch.cause, expected)
        if last.any() and self.cause is not None:
            same &= (stretch.energy[-1], stretch.eaten[-1]) == self.at_death
        if not same:
            raise Trouble(
                f"{self.run.path}: the life of organism {self.record.id[0]} did not repeat as recorded;"
                " `primordia verify` tells whether this machine gives the run's bits"
            )

    @cached_property
    def at_death(self) -> tuple[int, int]:
        """Energy left and food eaten as recorded at death, fixed point."""
        own = (pc.field("world") == self.world) & (pc.field("id") == int(self.record.id[0]))
        deaths = self.run.segments("deaths", ("world", "id", "energy", "food"))
        row = next(row for segment in deaths for row in segment.filter(own).to_pylist())
        return round(row["energy"] * ONE), round(row["food"] * ONE)

    @property
    def _seed(self) -> Wide:
        """The seed of the world, (1,)."""
        return wide(self.run.world_seeds[self.record.world])

    @cached_property
    def _past(self) -> PastClimate:
        return PastClimate(self.run)

    def _rates(self, ticks: np.ndarray) -> Rates:
        """Return the metabolism in force in each tick, float32 (n,) each."""
        itself = self.record.take(np.zeros(len(ticks), int))
        return Rates.of(jax.tree.map(jnp.asarray, self._past.of_lives(itself, ticks)))
