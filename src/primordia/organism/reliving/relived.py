"""A life lived again, tick for tick.

A life is a function of the organism's genome, the world's seed, and the tick and cell of birth (the
first promise). So the neighbours need not live again. If children inherit memory, the ancestors must:
a life is then also a function of its parent's memory at the birth.
"""

from collections.abc import Generator, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pyarrow.compute as pc
from jax import Array

from primordia.brains.contract import Genome
from primordia.compiled import shared
from primordia.config import Config
from primordia.errors import InputError, Trouble
from primordia.habitats.archipelago import at, body_in
from primordia.habitats.contract import AnyHabitat
from primordia.history import pedigree
from primordia.history.births import place_in
from primordia.history.climate import PastClimate
from primordia.history.rebuilding import ancestors
from primordia.law.genesis import words_of
from primordia.law.law import Law
from primordia.law.life import BODILY, Vitals, first_memory, inherits_memory
from primordia.law.metabolism import ONE, Rates, to_fixed_point
from primordia.law.world import Cause, Climate
from primordia.organism.mind import Mind
from primordia.organism.reliving.in_jax import LifeInJax
from primordia.organism.reliving.instant import Instant, Stretch
from primordia.organism.reliving.on_host import LifeOnHost
from primordia.progress import steps
from primordia.random.keys import Purpose, bits, chance, stream
from primordia.random.wide import Wide, wide
from primordia.runs.arrays import world_ticks
from primordia.runs.lives import Lives
from primordia.runs.records import Records

ALONE = (*BODILY, Cause.HAZARD)
"""Causes of death that are found when a life is lived alone: all but a neighbour's child and a resume."""

SHORT = 256
"""Ticks of one stretch of an ancestor's life, which ends soon: every tick of a stretch is computed."""


@dataclass(frozen=True)
class RelivedLife:
    """The inputs of a life, and its record."""

    run: Records
    config: Config
    law: Law
    habitat: AnyHabitat
    """the habitat that draws pictures; each time the life is lived, a new habitat is used"""
    genome: Genome
    """a single genome, first axis 1"""
    record: Lives
    """a single row"""
    stored: Mapping[str, np.ndarray] | None
    """arrays of the state in which the relived life begins; None: it begins with the birth"""
    first: Array | None = None
    """the memory at birth, float32 (1, M), if it is known"""

    @classmethod
    def of(
        cls,
        run: Records,
        organism: int,
        world: int = 0,
        stored: Mapping[str, np.ndarray] | None = None,
    ) -> "RelivedLife":
        """Prepare the life of an organism.

        Args:
            run: the organism's run.
            organism: birth number.
            world: the organism's world.
            stored: arrays of one of the run's checkpoints, in which the organism is alive; the life
                begins there. By default the life begins with the birth, or with the fork if the
                organism is older.

        Raises:
            InputError: no such organism was born, or its life cannot be lived again.
        """
        row = np.array([run.lives.row(organism, world)])
        return cls._of_record(run, run.lives.take(row), pedigree.genomes(run, row)[0], stored)

    @classmethod
    def _of_record(
        cls,
        run: Records,
        record: Lives,
        genome: np.ndarray,
        stored: Mapping[str, np.ndarray] | None = None,
    ) -> "RelivedLife":
        """Prepare a life from its record, a single row, and its genome, float32 (P,); see `of`."""
        habitat, law, begin = at(run.habitat, int(record.cell[0])), run.law, "the checkpoint"
        if stored is None and record.inherited[0]:
            stored, begin = run.origin, "the fork"
        if stored is not None and not habitat.exact:
            raise InputError(
                f"{run.path}: organism {record.id[0]} is older than {begin}, and the habitat cannot"
                " save bodies"
            )
        own = law.heredity.layout.split(np.array(genome[None]))
        blocks = {name: jax.device_put(block) for name, block in own.items()}
        return cls(run, run.config, law, habitat, blocks, record, stored)

    @property
    def world(self) -> int:
        """The number of the organism's world."""
        return int(self.record.world[0])

    @property
    def island(self) -> str:
        """The name of the island on which the organism lives; "" without islands."""
        return self.config.islands.names[int(self.config.islands.of_cells(self.record.cell[0]))]

    @property
    def begins(self) -> int:
        """The tick after which the relived life begins: the tick of the birth or of the stored state."""
        if self.stored is None:
            return int(self.record.born[0])
        return int(world_ticks(self.stored)[self.world])

    @property
    def ends(self) -> int:
        """The tick of death, or the world's last tick so far."""
        return int(self.record.ended[0])

    @property
    def cause(self) -> Cause | None:
        """The cause of death; None if the organism is alive."""
        return Cause(self.record.cause[0]) if self.record.died[0] else None

    @cached_property
    def memory(self) -> Array:
        """The memory with which the relived life begins, float32 (1, M).

        If it is inherited, the ancestors live again, each up to the birth of the next one, from the
        founder or from the fork on.
        """
        if self.stored is not None:
            return self._own(self.stored, "memory")
        if self.first is not None:
            return self.first
        of = ancestors(self.run, self.record) if inherits_memory(self.law) else []
        line = [*(self._of_record(self.run, *each) for each in of), self]
        memory, a_child = jnp.zeros((1, self.law.memory), jnp.float32), np.zeros(1, bool)
        for parent, child in steps(list(pairwise(line)), "living ancestors again"):
            own = memory if parent.stored is None else None
            at_birth = replace(parent, first=own)._memory_at(child.begins)
            memory = shared(first_memory, self.law.alone)(at_birth, a_child)
        return memory

    def _memory_at(self, tick: int) -> Array:
        """Live the life up to a tick, as recorded. Return the memory at its end, float32 (1, M)."""
        for held, stretch in self.instants(until=tick):
            memory = held["world.organisms.memory"]
            if stretch is not None:
                self._check(stretch)
        return jax.device_put(memory)

    def stretches(self, watched: bool = False) -> Generator[Stretch, None, None]:
        """Live the whole life in order, and yield it some ticks at a time.

        Args:
            watched: whether pictures are needed. If so, a habitat on the host makes them.

        Raises:
            Trouble: the life does not repeat as recorded.
        """
        for _, stretch in self.instants(watched):
            if stretch is not None:
                self._check(stretch)
                yield stretch

    def instants(
        self, watched: bool = False, until: int | None = None
    ) -> Generator[tuple[dict[str, np.ndarray], Stretch | None], None, None]:
        """Live the life up to its recorded end or an earlier death, without comparing it with the record.

        Args:
            watched: as in `stretches`.
            until: the last tick to live; by default the recorded end.

        Yields:
            Two values, at first and after each stretch. The first value holds the memory, the
            energy, the food, and the body or its senses by their names in a checkpoint, (1, ...)
            each. The second value is the stretch; at first it is None. A death ends a stretch, and
            memory and body have no meaning after a death.
        """
        with closing(self._alone(watched)) as alone:
            instant = self._start(alone)
            yield _as_stored(alone, instant), None
            ends, most = (self.ends, alone.TICKS) if until is None else (until, SHORT)
            for first in steps(range(self.begins, ends, most), "living again"):
                ticks = first + 1 + np.arange(most)
                climate = self._climate(ticks)
                count = min(most, ends - first)
                given = self._given(ticks)
                instant, stretch = alone.live(instant, ticks, Rates.of(climate), given, count)
                stretch = self._with_accidents(stretch, ticks, climate)
                died = np.flatnonzero(stretch.cause >= 0)[:1]
                yield _as_stored(alone, instant), stretch.take(np.s_[: (*(died + 1), count)[0]])
                if len(died):
                    return

    def _with_accidents(self, stretch: Stretch, ticks: np.ndarray, climate: Climate) -> Stretch:
        """Return a stretch with the accidents of this cell, drawn from the world's seed."""
        if not self.law.has_hazard:
            return stretch
        cell = jax.device_put(self.record.cell)
        struck = np.asarray(shared(_struck)(self._seed, wide(ticks), cell, climate["hazard"]))
        struck = struck[: len(stretch.tick)] & (stretch.cause < 0)
        return stretch._replace(cause=np.where(struck, np.int32(Cause.HAZARD), stretch.cause))

    def _alone(self, watched: bool) -> LifeInJax | LifeOnHost:
        """Return the stepper of brain and body, with a new habitat."""
        mind = Mind(self.genome, self._seed, jax.device_put(self.record.cell))
        habitat = at(self.config.build_habitat(), int(self.record.cell[0]))
        if habitat.kind == "host":
            return LifeOnHost(self.law, mind, habitat, watched)
        return LifeInJax(self.law, mind, habitat)

    def _start(self, alone: LifeInJax | LifeOnHost) -> Instant:
        """Return the state in which the relived life begins."""
        if self.stored is not None:
            return self._restored(alone, self.stored)
        key = stream(self._seed, Purpose.BODY, wide(self.record.born))
        cell = jax.device_put(self.record.cell)
        words = words_of(self.law, self.genome, key, cell, self.habitat.words)
        if self.law.act is None:
            store = to_fixed_point(self._climate(np.array([self.begins]))["metabolism.store"])
        else:
            store = jax.device_put(self.run.endowments_of(self.record))
        vitals = Vitals(store, jnp.zeros(1, jnp.int32))
        return Instant(self.memory, vitals, alone.embody(words))

    def _restored(self, alone: LifeInJax | LifeOnHost, arrays: Mapping[str, np.ndarray]) -> Instant:
        (place,) = self._place(arrays)
        bodies = body_in(arrays, self.config.islands, place)
        memory, energy, eaten = (self._own(arrays, name) for name in ("memory", "energy", "eaten"))
        return Instant(memory, Vitals(energy, eaten), alone.restore(bodies))

    def _own(self, arrays: Mapping[str, np.ndarray], name: str) -> Array:
        """Return the organism's own values of an array of a state, (1, ...)."""
        return jax.device_put(arrays[f"world.organisms.{name}"][self._place(arrays)])

    def _place(self, arrays: Mapping[str, np.ndarray]) -> list[int]:
        return [place_in(arrays, int(self.record.id[0]), self.world)]

    def _check(self, stretch: Stretch) -> None:
        """Compare a stretch with the record: tick and cause of death, energy left, food eaten.

        Deaths by neighbours are not repeated: the organism is then alive at its last tick.
        """
        last = stretch.tick == self.ends
        expected = np.where(last & (self.cause in ALONE), int(self.cause or 0), -1)
        same = np.array_equal(stretch.cause, expected)
        if last.any() and self.cause is not None:
            same &= (stretch.energy[-1], stretch.eaten[-1]) == self.at_death
        if not same:
            raise Trouble(
                f"{self.run.path}: the life of organism {self.record.id[0]} did not repeat as"
                " recorded; `primordia verify` tells whether this machine repeats the run"
            )

    @cached_property
    def at_death(self) -> tuple[int, int]:
        """Energy left and food eaten as recorded at death, fixed point."""
        return round(self.death["energy"] * ONE), round(self.death["food"] * ONE)

    @cached_property
    def death(self) -> dict[str, Any]:
        """The row of the organism's death, by column."""
        own = (pc.field("world") == self.world) & (pc.field("id") == int(self.record.id[0]))
        columns = ("world", "id", "tick", "cause", "energy", "food", *self.run.schema.tallies)
        deaths = self.run.segments("deaths", columns)
        return next(row for segment in deaths for row in segment.filter(own).to_pylist())

    def _given(self, ticks: np.ndarray) -> np.ndarray:
        """Return the endowment of the child born in each tick: int32 (n,), fixed point, 0 without one."""
        born, endowments = self._children
        given = np.zeros(len(ticks), np.int32)
        here = np.isin(born, ticks)
        given[born[here] - ticks[0]] = endowments[here]
        return given

    @cached_property
    def _children(self) -> tuple[np.ndarray, np.ndarray]:
        """The ticks at which the organism's children were born, and their endowments, (n,) each."""
        lives = self.run.lives
        own = (lives.world == self.world) & (lives.parent == self.record.id[0])
        if self.law.act is None or not own.any():
            return np.zeros(0, np.int64), np.zeros(0, np.int32)
        children = lives.take(np.flatnonzero(own))
        return children.born, self.run.endowments_of(children)

    @property
    def _seed(self) -> Wide:
        """The seed of the world, (1,)."""
        return wide(self.run.world_seeds[self.record.world])

    @cached_property
    def _past(self) -> PastClimate:
        return PastClimate(self.run)

    def _climate(self, ticks: np.ndarray) -> Climate:
        """Return the settings in force in each tick, float32 (n,) each."""
        itself = self.record.take(np.zeros(len(ticks), int))
        return jax.device_put(self._past.of_lives(itself, ticks))


def _as_stored(alone: LifeInJax | LifeOnHost, instant: Instant) -> dict[str, np.ndarray]:
    energy, eaten = instant.vitals
    own = {"memory": instant.memory, "energy": energy, "eaten": eaten}
    held = {f"world.organisms.{name}": np.asarray(array) for name, array in own.items()}
    return held | alone.stored_as(instant.bodies)


def _struck(seed: Wide, ticks: Wide, cell: Array, hazard: Array) -> Array:
    """Return whether an accident hits the cell in each tick (n,), bool; see `law.tick.judge`."""
    return chance(bits(stream(seed, Purpose.HAZARD, ticks), cell).hi, hazard)
