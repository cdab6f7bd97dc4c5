"""A life lived again, tick for tick: from an organism's genome, its world's seed, and where it was born.

Nothing else enters (the first of the promises), so the neighbours need not live again with it.
"""

from collections.abc import Callable, Generator
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property

import jax.numpy as jnp
import numpy as np
import pyarrow.compute as pc

from primordia.brains.contract import Genome
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.habitats.contract import AnyHabitat
from primordia.history.climate import climate_at
from primordia.history.lineage import place_in, rebuild
from primordia.law.genesis import body_words
from primordia.law.law import Law
from primordia.law.life import BODILY, Vitals
from primordia.law.metabolism import ONE, Rates, to_fixed_point
from primordia.law.world import Cause
from primordia.organism.life.in_jax import LifeInJax
from primordia.organism.life.instant import Instant, Mind, Stretch
from primordia.organism.life.on_host import LifeOnHost
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives

KEPT = "memory", "energy", "eaten"
"""What a fork keeps of an organism, beside its genome and body."""


@dataclass(frozen=True)
class Life:
    """What a life is a function of, and what is recorded of it."""

    run: Archive
    config: Config
    law: Law
    habitat: AnyHabitat
    """to ask for pictures; each time the life is lived it is in a habitat of its own"""
    genome: Genome
    """of one"""
    record: Lives
    """of one"""

    @classmethod
    def of(cls, run: Archive, organism: int, world: int = 0) -> "Life":
        """An organism's.

        Raises:
            InputError: no such organism was born, or it cannot be lived again.
        """
        habitat, law, row = run.habitat, run.law, run.lives.row(organism, world)
        genome = law.layout.split(jnp.asarray(rebuild(run, organism, world)[None]))
        record = run.lives.take(np.array([row]))
        life = cls(run, run.config, law, habitat, genome, record)
        if life.was_found and not habitat.exact:
            raise InputError(
                f"{run.path}: organism {organism} is older than the fork, and its habitat cannot save"
                " bodies"
            )
        return life

    @property
    def world(self) -> int:
        """Where it was lived."""
        return int(self.record.world[0])

    @property
    def was_found(self) -> bool:
        """Whether a fork found it, and it can be lived again only from there."""
        fork = self.config.fork
        return fork is not None and int(self.record.born[0]) <= fork.tick

    @property
    def begins(self) -> int:
        """The tick from whose end it can be lived again: its birth, or the fork's."""
        fork = self.config.fork
        return max(int(self.record.born[0]), fork.tick if fork else 0)

    @property
    def ends(self) -> int:
        """The tick of its death, or its world's last so far."""
        return int(self.record.ended[0])

    @property
    def cause(self) -> Cause | None:
        """Of its death, if it died."""
        return Cause(self.record.cause[0]) if self.record.died[0] else None

    def again(self, watched: bool = False) -> Generator[Stretch, None, None]:
        """All of it, in order, some ticks at a time.

        Args:
            watched: pictures will be asked for, so a habitat on the host is to make them.

        Raises:
            Trouble: its death does not come where it is recorded.
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
        mind = Mind(self.genome, self._seed, jnp.asarray(self.record.cell))
        habitat = self.config.build_habitat()
        if habitat.kind == "host":
            return LifeOnHost(self.law, mind, habitat, watched)
        return LifeInJax(self.law, mind, habitat)

    def _start(self, alone: LifeInJax | LifeOnHost) -> Instant:
        """Where it begins: at birth, or where a fork found it."""
        if self.was_found:
            return self._as_found(alone)
        key = stream(self._seed, Purpose.BODY, wide(self.record.born))
        words = body_words(key, jnp.asarray(self.record.cell), self.habitat.words)
        memory = jnp.zeros((1, self.law.memory), jnp.float32)
        store = self._rates(np.array([self.begins])).store
        vitals = Vitals(to_fixed_point(store), jnp.zeros(1, jnp.int32))
        return Instant(memory, vitals, alone.embody(words))

    def _as_found(self, alone: LifeInJax | LifeOnHost) -> Instant:
        arrays = self.run.origin
        assert arrays is not None
        cell = [place_in(arrays, self.law, int(self.record.id[0]), self.world)]
        own = {name: jnp.asarray(arrays[f"world.organisms.{name}"][cell]) for name in KEPT}
        bodies = {n: a[cell] for n, a in arrays.items() if n.startswith("bodies")}
        vitals = Vitals(own["energy"], own["eaten"])
        return Instant(own["memory"], vitals, alone.restore(bodies))

    def _check(self, stretch: Stretch) -> None:
        """Compare with the record: the tick and cause of death, the energy left and the food eaten.

        A death that only neighbours or chance can give is not repeated; the body lives on until then.
        """
        last = stretch.tick == self.ends
        expected = np.where(last & (self.cause in BODILY), int(self.cause or 0), -1)
        same = np.array_equal(stretch.cause, expected)
        if last.any() and self.cause is not None:
            same &= (stretch.energy[-1], stretch.eaten[-1]) == self.at_death
        if not same:
            raise Trouble(
                f"{self.run.path}: organism {self.record.id[0]} did not live again as recorded;"
                " `primordia verify` tells whether this machine gives the run's bits"
            )

    @cached_property
    def at_death(self) -> tuple[int, int]:
        """Energy left and food eaten, as recorded at its death; fixed point."""
        own = (pc.field("world") == self.world) & (pc.field("id") == int(self.record.id[0]))
        deaths = self.run.segments("deaths", ("world", "id", "energy", "food"))
        row = next(row for segment in deaths for row in segment.filter(own).to_pylist())
        return round(row["energy"] * ONE), round(row["food"] * ONE)

    @property
    def _seed(self) -> Wide:
        """Of its world, (1,)."""
        return wide([self.config.seed + self.world])

    @cached_property
    def _climate(self) -> Callable[[np.ndarray], dict[str, np.ndarray]]:
        return climate_at(self.run, self.world)

    def _rates(self, ticks: np.ndarray) -> Rates:
        """The metabolism in force, float32 (n,) each."""
        climate = self._climate(ticks)
        return Rates(*(jnp.asarray(climate[f"metabolism.{name}"]) for name in Rates._fields))
