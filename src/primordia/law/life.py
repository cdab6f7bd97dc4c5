"""One tick of an organism: its brain thinks, its motor acts, what befell its body is judged."""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.habitats.contract import Discrete, Outcome
from primordia.law.law import Law
from primordia.law.metabolism import Rates, add, fixed, metabolise
from primordia.law.motor import argmax
from primordia.law.mutation import noise_index
from primordia.law.world import Cause, Organisms, World, Worlds
from primordia.random.gaussian import quantiles
from primordia.random.keys import Purpose, Streams, bits, chance, streams
from primordia.random.wide import Wide, signed, total


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
