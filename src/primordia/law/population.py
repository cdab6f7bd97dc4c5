"""Settling: worlds are brought up to date after some ticks, with births, deaths, seasons and samples."""

import jax.numpy as jnp
from jax import Array, lax

from primordia.law import turnover
from primordia.law.events import Events
from primordia.law.law import Law
from primordia.law.moments import until_due
from primordia.law.sample import note_samples
from primordia.law.seasons import Schedule, apply_seasons
from primordia.law.tick import Fates
from primordia.law.world import World
from primordia.random.wide import happened, select, times, wide


def lifeless(law: Law, world: World, running: Array) -> Array:
    """Return which running worlds have no living organism, as before genesis: bool (W,)."""
    return running & ~law.by_world(world.organisms.alive).any(axis=1)


def settle(
    law: Law, world: World, events: Events, fates: Fates, ticks: Array, running: Array
) -> tuple[World, Events, Array]:
    """Bring worlds up to date after some ticks, of which only the last may have been eventful.

    Args:
        law: the law.
        world: the world with its organisms after those ticks, as `rest` returns them.
        events: lists with room for one tick (`events.have_room`).
        fates: fates of the last tick.
        ticks: number of these ticks, at most `quiet_ticks`, 0 for genesis; int32 ().
        running: worlds that run, bool (W,); the others do not change.

    Returns:
        world, events, cells whose organism was born in the last tick (bool (C,)).
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
    none_born = jnp.zeros_like(organisms.alive)
    keys = turnover.birth_keys(law, worlds)
    world, events, newborn = lax.cond(
        fates.eventful | lifeless(law, world, running).any(),
        lambda world, events: turnover.turnover(law, world, events, running, fates, keys),
        lambda world, events: (world, events, none_born),
        World(organisms, worlds),
        events,
    )
    return *_end_tick(law, world, events, running), newborn


def quiet_ticks(law: Law, world: World, running: Array) -> Array:
    """Return the number of ticks until the next due change, if no tick is eventful: int32 ().

    The number is 0 before genesis.
    """
    worlds, far = world.worlds, 2**31 - 1
    due = [worlds.sample_wait, *worlds.looks.wait.T]
    if law.heredity.mutation.moments is not None:
        due.append(until_due(law.heredity.mutation.moments, worlds))
    due.append(
        jnp.where(worlds.calm < law.saturation_ticks, law.saturation_ticks - worlds.calm, far)
    )
    for season in law.seasons:
        if isinstance(season, Schedule):
            due.append(worlds.tick.until(wide(season.at)))
    soonest = jnp.stack(due).min(axis=0)
    soonest = jnp.where(lifeless(law, world, running), 0, soonest)
    return jnp.where(running, soonest, far).min()


def _end_tick(law: Law, world: World, events: Events, running: Array) -> tuple[World, Events]:
    """Record saturation, apply seasons and take samples at the end of a tick."""
    organisms, worlds = world
    full = law.by_world(organisms.alive).all(axis=1)
    long_calm = worlds.calm >= law.saturation_ticks
    newly = running & full & long_calm & ~happened(worlds.saturated)
    worlds = worlds._replace(
        saturated=select(newly, worlds.tick, worlds.saturated),
        saturated_births=select(newly, worlds.births, worlds.saturated_births),
    )
    changed = jnp.zeros_like(running)
    if law.seasons:
        worlds, changed = apply_seasons(
            law.seasons, law.governed, World(organisms, worlds), running
        )
    periodic = worlds.sample_wait == 0
    worlds = worlds._replace(sample_wait=jnp.where(periodic, law.sample_every, worlds.sample_wait))
    world, due = World(organisms, worlds), running & (periodic | changed)
    samples = lax.cond(
        due.any(), lambda s: note_samples(law, world, due, s), lambda s: s, events.samples
    )
    return world, events._replace(samples=samples)
