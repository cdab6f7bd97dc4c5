"""The law of life, once, for every habitat: pure functions with the habitat between them.

    think(law, world, senses, keys)                   -> world, action
    judge(law, world, outcome, keys, active)          -> world, fates
    rest(before, after, active)                       -> world
    settle(law, world, events, fates, ticks, running) -> world, events, born

Brains think and fates are judged in every tick. When a tick has an event, or something falls due,
those that should not have moved are put back, and births, deaths, counts and seasons are settled;
until then ticks only pass.

A tick bears the number of ticks its world has then lived through: an organism born in tick b that
dies in tick d lived d - b ticks, and acted for the first time in tick b + 1.
"""

from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Literal, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.gaussian import quantiles
from primordia.habitats import Continuous, Discrete, Outcome
from primordia.keys import Purpose, Streams, bits, chance, streams
from primordia.law import turnover
from primordia.law.brain import Brain
from primordia.law.events import Events
from primordia.law.metabolism import Metabolism, Rates, add, fixed, metabolise
from primordia.law.motor import Motor, argmax
from primordia.law.mutation import BlockSetting, Mutation, noise_index
from primordia.law.placement import Placement
from primordia.law.sample import note_samples
from primordia.law.seasons import Columns, Ratchet, Schedule, turn
from primordia.law.world import Cause, Organisms, World, Worlds
from primordia.wide import Wide, happened, select, signed, times, total, wide


@dataclass(frozen=True)
class Law:
    """What holds in W worlds of N cells; everything here is fixed for a run."""

    worlds: int
    cells: int
    """of one world"""
    brain: Brain
    action: Discrete | Continuous
    motor: Motor
    placement: Placement
    mutation: Mutation
    ancestors: np.ndarray | None
    """genomes that founders take in turn, float32 (K, P); None: founders are random"""
    metabolism: Metabolism | None
    replication: float
    hazard: float
    inheritance: Literal["parent", "founder"]
    genesis: Literal["one", "fill"]
    seasons: tuple[Schedule | Ratchet, ...]
    saturation_ticks: int
    """a full world in which nobody died for this long is saturated"""
    sample_every: int

    def by_world(self, per_cell: Array) -> Array:
        """(C, ...) -> (W, N, ...)."""
        return per_cell.reshape(self.worlds, self.cells, *per_cell.shape[1:])

    def per_cell(self, per_world: Array) -> Array:
        """(W,) -> (C,)."""
        return jnp.broadcast_to(per_world[:, None], (self.worlds, self.cells)).ravel()

    @cached_property
    def blocks(self) -> list[str]:
        """Names of the genome's blocks, in order."""
        return list(self.brain.blocks)

    @cached_property
    def block_sizes(self) -> np.ndarray:
        """Weights in each block, (B,)."""
        return np.array([prod(shape) for shape in self.brain.blocks.values()])

    @cached_property
    def founder_scale(self) -> np.ndarray:
        """Standard deviation of each of a founder's weights, float32 (P,)."""
        scales = self.mutation.of_blocks("founder_scale", self.blocks)
        return np.repeat(np.array(scales, np.float32), self.block_sizes)

    @cached_property
    def columns(self) -> Columns:
        """Which blocks each setting under `mutation` governs."""
        found: Columns = {}
        fields: tuple[BlockSetting, ...] = ("probability", "scale")
        for field in fields:
            own = self.mutation.own(field, self.blocks)
            found[f"mutation.{field}"] = [i for i, value in enumerate(own) if value is None]
            for i, block in enumerate(self.blocks):
                found[f"mutation.blocks.{block}.{field}"] = [i]
        return found

    @property
    def cell_numbers(self) -> Array:
        """Number of each cell within its world, int32 (C,)."""
        return jnp.tile(jnp.arange(self.cells, dtype=jnp.int32), self.worlds)


def keys_of(worlds: Worlds, ticks: Array) -> Streams:
    """What think and judge draw from in the tick so many (int32 ()) after the last one settled, (W,)."""
    tick = worlds.tick.plus(jnp.full_like(worlds.calm, ticks))
    return streams(worlds.seed, tick, Purpose.MOTOR, Purpose.HAZARD, Purpose.REPLICATE)


class Fates(NamedTuple):
    """What becomes of the organisms in one tick, (C,)."""

    cause: Array
    """int32: of its death, or -1"""
    wants: Array
    """bool: lives on, and would copy itself now if there is room"""
    eventful: Array
    """bool (): somebody dies, or may be born"""


def no_fates(law: Law) -> Fates:
    """Nothing happens to anybody."""
    cells = law.worlds * law.cells
    nobody = jnp.zeros(cells, bool)
    return Fates(jnp.full(cells, -1, jnp.int32), nobody, jnp.zeros((), bool))


def think(law: Law, world: World, senses: Array, keys: Streams) -> tuple[World, Array]:
    """Brains of all cells, one tick; `rest` then undoes what is not to be.

    Args:
        law: the law.
        world: before the tick.
        senses: float32 (C, S).
        keys: of the tick.

    Returns:
        world with memories advanced; action, int32 (C,) or float32 (C, A).
    """
    organisms, worlds = world
    memory, output = law.brain(organisms.genome, organisms.memory, senses)
    faulty = (~jnp.isfinite(output)).any(axis=1)
    organisms = organisms._replace(memory=memory, faulty=faulty)
    key = keys[Purpose.MOTOR].map(law.per_cell)
    return World(organisms, worlds), act(law, key, law.cell_numbers, output)


def act(law: Law, key: Wide, cells: Array, output: Array) -> Array:
    """What outputs (N, A) of brains in these cells (N,) of their worlds do, with motor keys (N,)."""
    if isinstance(law.action, Discrete):
        return argmax(output)
    if law.motor.kind == "direct":
        return output
    table = jnp.asarray(quantiles() * np.float32(law.motor.sd))
    return output + table[noise_index(key, cells, law.action.size)]


def judge(
    law: Law, world: World, outcome: Outcome, keys: Streams, active: Array
) -> tuple[World, Fates]:
    """What a tick in the habitat means for the active: they eat, die, want to copy themselves.

    Args:
        law: the law.
        world: after `think`.
        outcome: of the habitat, (C,) each.
        keys: of the tick.
        active: who lives in a world that runs, bool (C,).

    Returns:
        world with energy and food brought up to date; fates.
    """
    organisms, worlds = _eat(law, world, outcome, active)
    cause = _deaths(law, organisms, worlds, outcome, keys[Purpose.HAZARD])
    cause = jnp.where(active, cause, -1)
    replicates = _drawn(law, keys[Purpose.REPLICATE], worlds.climate.replication)
    wants = replicates & active & (cause < 0)
    room = law.placement.room(law.by_world(organisms.alive)).ravel()
    eventful = ((cause >= 0) | (wants & room)).any()
    return World(organisms, worlds), Fates(cause, wants, eventful)


def _eat(law: Law, world: World, outcome: Outcome, active: Array) -> World:
    organisms, worlds = world
    if law.metabolism is not None:
        rates = Rates(*(law.per_cell(rate) for rate in worlds.climate.metabolism))
        energy = metabolise(organisms.energy, outcome.food, outcome.effort, rates)
        organisms = organisms._replace(energy=energy)
    if outcome.food is not None:
        food = jnp.where(active, fixed(outcome.food), 0)
        organisms = organisms._replace(eaten=add(organisms.eaten, food))
        by_world = signed(food).map(law.by_world)
        worlds = worlds._replace(food=worlds.food + total(by_world, axis=1))
    return World(organisms, worlds)


def _deaths(
    law: Law, organisms: Organisms, worlds: Worlds, outcome: Outcome, hazard: Wide
) -> Array:
    """Cause of death, or -1: int32 (C,). Of several, the one written last here counts."""
    fault = organisms.faulty
    for number in (outcome.food, outcome.effort):
        fault = fault if number is None else fault | ~jnp.isfinite(number)
    if outcome.fault is not None:
        fault = fault | outcome.fault
    cause = jnp.full(fault.shape, -1, jnp.int32)
    if law.hazard > 0 or any(season.setting == "hazard" for season in law.seasons):
        struck = _drawn(law, hazard, worlds.climate.hazard)
        cause = jnp.where(struck, Cause.HAZARD, cause)
    if law.metabolism is not None:
        cause = jnp.where(organisms.energy <= 0, Cause.STARVED, cause)
    cause = jnp.where(outcome.fatal, Cause.FATAL, cause)
    return jnp.where(fault, Cause.FAULT, cause)


def _drawn(law: Law, key: Wide, probability: Array) -> Array:
    """An event of given probability (W,) for every cell: bool (C,)."""
    word = bits(key.take(np.s_[:, None]), jnp.arange(law.cells)[None]).hi
    return chance(word, probability[:, None]).ravel()


def rest(before: Organisms, after: Organisms, active: Array) -> Organisms:
    """Who is not active, in an empty cell or a world that has stopped, stays as before."""

    def keep(new: Array, old: Array) -> Array:
        return jnp.where(active.reshape(-1, *[1] * (new.ndim - 1)), new, old)

    return before._replace(
        memory=keep(after.memory, before.memory),
        energy=keep(after.energy, before.energy),
        eaten=keep(after.eaten, before.eaten),
        faulty=keep(after.faulty, before.faulty),
    )


def lifeless(law: Law, world: World, running: Array) -> Array:
    """Which running worlds have nobody alive, as before genesis: bool (W,)."""
    return running & ~law.by_world(world.organisms.alive).any(axis=1)


def settle(
    law: Law, world: World, events: Events, fates: Fates, ticks: Array, running: Array
) -> tuple[World, Events, Array]:
    """Bring the counts up to date by some ticks, of which only the last may have been eventful.

    Args:
        law: the law.
        world: its organisms as `rest` left them after those ticks.
        events: lists with room for one tick (`events.have_room`).
        fates: of the last tick.
        ticks: int32 (), at most as many as `quiet_ticks` said; 0 for genesis.
        running: which worlds are, bool (W,); the others stay as they are.

    Returns:
        world, events, who was born in the last tick (bool (C,)).
    """
    organisms, worlds = world
    passed = jnp.where(running, ticks, 0)
    population = law.by_world(organisms.alive).sum(axis=1, dtype=jnp.uint32)
    worlds = worlds._replace(
        tick=worlds.tick.plus(passed),
        organism_ticks=worlds.organism_ticks + times(population, passed),
        calm=jnp.minimum(worlds.calm, 2**31 - 1 - passed) + passed,
        sample_wait=worlds.sample_wait - passed,
        looks=worlds.looks._replace(wait=worlds.looks.wait - passed[:, None]),
    )
    nobody = jnp.zeros_like(organisms.alive)
    keys = turnover.birth_keys(worlds)
    world, events, born = lax.cond(
        fates.eventful | lifeless(law, world, running).any(),
        lambda world, events: turnover.turnover(
            law, world, events, running, fates.wants, fates.cause, keys
        ),
        lambda world, events: (world, events, nobody),
        World(organisms, worlds),
        events,
    )
    return *_watch(law, world, events, running), born


def quiet_ticks(law: Law, world: World, running: Array) -> Array:
    """How many ticks can pass before anything falls due, int32 (), if none of them is eventful.

    None can before genesis.
    """
    worlds, far = world.worlds, 2**31 - 1
    due = [worlds.sample_wait, *worlds.looks.wait.T]
    due.append(
        jnp.where(worlds.calm < law.saturation_ticks, law.saturation_ticks - worlds.calm, far)
    )
    for season in law.seasons:
        if isinstance(season, Schedule):
            due.append(worlds.tick.until(wide(season.at)))
    soonest = jnp.stack(due).min(axis=0)
    soonest = jnp.where(lifeless(law, world, running), 0, soonest)
    return jnp.where(running, soonest, far).min()


def _watch(law: Law, world: World, events: Events, running: Array) -> tuple[World, Events]:
    """Saturation, seasons and samples at the end of a tick."""
    organisms, worlds = world
    full = law.by_world(organisms.alive).all(axis=1)
    calm = worlds.calm >= law.saturation_ticks
    newly = running & full & calm & ~happened(worlds.saturated)
    worlds = worlds._replace(
        saturated=select(newly, worlds.tick, worlds.saturated),
        saturated_births=select(newly, worlds.births, worlds.saturated_births),
    )
    changed = jnp.zeros_like(running)
    if law.seasons:
        worlds, changed = turn(law.seasons, law.columns, World(organisms, worlds), running)
    periodic = worlds.sample_wait == 0
    worlds = worlds._replace(sample_wait=jnp.where(periodic, law.sample_every, worlds.sample_wait))
    world, due = World(organisms, worlds), running & (periodic | changed)
    samples = lax.cond(
        due.any(), lambda s: note_samples(world, due, s), lambda s: s, events.samples
    )
    return world, events._replace(samples=samples)
