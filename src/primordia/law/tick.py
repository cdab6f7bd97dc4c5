"""One tick of all cells: each organism's tick (`life`), then accidents, replication and worlds' food.

Brains of empty cells and of stopped worlds think too, since it would cost more to leave them out.
The function `rest` then restores the organisms that must not change.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.habitats.bodies import select_bodies
from primordia.habitats.contract import Bodies, Outcome
from primordia.law import life
from primordia.law.law import Law
from primordia.law.life import Thought, Vitals
from primordia.law.metabolism import Rates, food_eaten
from primordia.law.world import Cause, Organisms, World, Worlds
from primordia.random.keys import Purpose, Streams, bits, chance, streams
from primordia.random.wide import Wide, signed, total


class Fates(NamedTuple):
    """The fates of all organisms in one tick, (C,)."""

    cause: Array
    """int32: cause of death, or -1"""
    wants: Array
    """bool: the organism lives on, and replicates in this tick if it finds a cell"""
    endowment: Array | None
    """int32, fixed point: what a child of this organism begins with; None unless replication is an act"""
    eventful: Array
    """bool (): an organism dies, or may be born"""


def no_fates(law: Law) -> Fates:
    """Return the fates of a tick without deaths and births."""
    cells = law.worlds * law.cells
    none = jnp.zeros(cells, bool)
    endowment = None if law.act is None else jnp.zeros(cells, jnp.int32)
    return Fates(jnp.full(cells, -1, jnp.int32), none, endowment, jnp.zeros((), bool))


def keys_of(worlds: Worlds, ticks: Array) -> Streams:
    """Return the keys of `think` and `judge` in a tick; `ticks` counts from the last settled tick.

    Each key is (W,), and `ticks` is int32 ().
    """
    tick = worlds.tick.plus(jnp.full_like(worlds.calm, ticks))
    return streams(worlds.seed, tick, Purpose.MOTOR, Purpose.HAZARD, Purpose.REPLICATE)


def think(law: Law, world: World, senses: Array, keys: Streams) -> Thought:
    """Advance the brains and motors of all cells by one tick, with the habitat's senses."""
    organisms, key = world.organisms, keys[Purpose.MOTOR].map(law.per_cell)
    senses = law.perceived(senses, organisms.energy)
    return life.think(law, organisms.genome, organisms.memory, senses, key, law.cell_numbers)


def judge(
    law: Law,
    world: World,
    thought: Thought,
    bodies: Bodies,
    outcome: Outcome,
    keys: Streams,
    active: Array,
) -> tuple[World, Fates]:
    """Judge a tick for the active organisms: they remember, eat, may die, and may want to replicate.

    Args:
        law: the law.
        world: the world before the tick.
        thought: thoughts of the tick.
        bodies: bodies after the tick; see `life.judge`.
        outcome: the habitat's outcome, (C,) each.
        keys: keys of the tick.
        active: the living in worlds that run, bool (C,).

    Returns:
        world with memory, energy and food brought up to date; fates.
    """
    organisms, worlds = world
    climate, tries = law.in_cells(worlds.climate), None
    vitals, rates = Vitals(organisms.energy, organisms.eaten), Rates.of(climate)
    vitals, cause = life.judge(law, vitals, thought.faulty, bodies, outcome, rates, thought.spent)
    if worlds.acts is not None and thought.copying is not None:
        vitals, tries = life.try_to_copy(law, vitals, cause, thought.copying, rates)
        tried = law.by_world(tries.tried & active)
        worlds = worlds._replace(acts=worlds.acts.tried(tried))
    organisms = organisms._replace(memory=thought.memory, **vitals._asdict())
    if outcome.food is not None:
        worlds = worlds._replace(food=worlds.food + _food(law, outcome.food, active))
    if law.has_hazard:
        struck = _drawn(law, keys[Purpose.HAZARD], climate["hazard"])
        cause = jnp.where(struck & (cause < 0), Cause.HAZARD, cause)
    cause = jnp.where(active, cause, -1)
    if tries is None:
        replicates = _drawn(law, keys[Purpose.REPLICATE], climate["replication"])
    else:
        replicates = tries.tried
    wants = replicates & active & (cause < 0)
    room = law.placement.room(law.by_world(organisms.alive)).ravel()
    eventful = ((cause >= 0) | (wants & room)).any()
    endowment = None if tries is None else tries.endowment
    return World(organisms, worlds), Fates(cause, wants, endowment, eventful)


def _food(law: Law, food: Array, active: Array) -> Wide:
    """Return the food of each world's active organisms in a tick, fixed point, (W,)."""
    eaten = signed(jnp.where(active, food_eaten(food), 0))
    return total(eaten.map(law.by_world), axis=1)


def _drawn(law: Law, key: Wide, probability: Array) -> Array:
    """Draw whether an event happens in each cell, from the cell's probability (C,): bool (C,)."""
    word = bits(key.take(np.s_[:, None]), jnp.arange(law.cells)[None]).hi
    return chance(word, law.by_world(probability)).ravel()


def rest(before: Organisms, after: Organisms, active: Array) -> Organisms:
    """Return organisms after some ticks. Organisms that are not `active`, bool (C,), are unchanged."""
    old, new = ((each.memory, each.energy, each.eaten) for each in (before, after))
    memory, energy, eaten = select_bodies(active, new, old)
    return before._replace(memory=memory, energy=energy, eaten=eaten)
