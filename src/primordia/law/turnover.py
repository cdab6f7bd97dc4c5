"""Turnover: the rare half of the law. The dead go, the newborn come, extinct worlds begin again.

Runs only in ticks in which something dies or may be born. What must be done for every weight of a
genome is done per birth; the rest is cheap enough to do for all cells at once.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.law import events as log
from primordia.law.events import Events, Rows
from primordia.law.heredity import Birth, Newborn, mutation_rates, newborn
from primordia.law.law import Law
from primordia.law.metabolism import fixed
from primordia.law.world import BirthCause, Cause, Organisms, World, Worlds
from primordia.mutations.contract import PURPOSES, Draws
from primordia.random.keys import Purpose, Streams, below, bits, bits_if, streams
from primordia.random.wide import Wide, happened, largest, never, select, zero


class Births(NamedTuple):
    """Who is born in this tick, (C,)."""

    born: Array
    """bool"""
    founded: Array
    """bool: from nothing, no parent"""
    parent: Array
    """int32, cell of the parent (on the axis of all worlds); meaningless where founded"""
    number: Wide
    """birth number within the world"""


def birth_keys(worlds: Worlds) -> Streams:
    """What the turnover of worlds at the end of this tick draws from, (W,)."""
    return streams(worlds.seed, worlds.tick, Purpose.PLACE, Purpose.GENESIS, *PURPOSES)


def turnover(
    law: Law,
    world: World,
    events: Events,
    running: Array,
    wants: Array,
    cause: Array,
    keys: Streams,
) -> tuple[World, Events, Array]:
    """Deaths and births of one tick.

    Args:
        law: the law.
        world: with `worlds.tick` the number of the tick that ends.
        events: where to note them.
        running: which worlds are, bool (W,).
        wants: which survivors replicate, bool (C,).
        cause: of each cell's death, int32 (C,), or -1.
        keys: those of the tick.

    Returns:
        world, events, who is born (C,).
    """
    organisms, worlds = world
    parent = _place(law, keys[Purpose.PLACE], wants, organisms.alive)
    cause = jnp.where(organisms.alive & (parent >= 0) & (cause < 0), Cause.REPLACED, cause)
    alive = (organisms.alive & (cause < 0)) | (parent >= 0)
    extinct = running & ~law.by_world(alive).any(axis=1)
    founded = _genesis(law, keys[Purpose.GENESIS], extinct).ravel()
    births = _births(law, worlds, parent, founded)

    events = events._replace(deaths=_note_deaths(law, organisms, worlds, cause, events.deaths))
    organisms, listed = _inherit(law, world, births, keys, events.births)
    organisms = _begin_lives(law, organisms, worlds, births, alive | founded)
    worlds = _count(law, worlds, organisms, births, cause, extinct)
    return World(organisms, worlds), events._replace(births=listed), births.born


def _place(law: Law, key: Wide, wants: Array, alive: Array) -> Array:
    """The parent (on the axis of all cells) of each newborn, or -1: int32 (C,)."""
    key, cells = key.take(np.s_[:, None]), jnp.arange(law.cells)[None]

    def draw(number: Array) -> Wide:
        return bits_if(wants.any(), key, cells, number)

    parent = law.placement.parents(draw, law.by_world(wants), law.by_world(alive))
    first = law.cells * jnp.arange(law.worlds, dtype=jnp.int32)[:, None]
    return jnp.where(parent >= 0, parent + first, -1).ravel()


def _genesis(law: Law, key: Wide, extinct: Array) -> Array:
    """Where founders appear: bool (W, N)."""
    if law.genesis == "fill":
        return jnp.broadcast_to(extinct[:, None], (law.worlds, law.cells))
    chosen = below(bits(key, jnp.zeros_like(key.lo)).hi, law.cells)
    return extinct[:, None] & (jnp.arange(law.cells)[None] == chosen[:, None])


def _births(law: Law, worlds: Worlds, parent: Array, founded: Array) -> Births:
    born = (parent >= 0) | founded
    rank = jnp.cumsum(law.by_world(born), axis=1, dtype=jnp.int32).ravel() - 1
    number = worlds.births.map(law.per_cell).plus(jnp.maximum(rank, 0))
    return Births(born, founded, jnp.maximum(parent, 0), number)


def _note_deaths(
    law: Law, organisms: Organisms, worlds: Worlds, cause: Array, deaths: Rows
) -> Rows:
    tick = worlds.tick.map(law.per_cell)

    def note(cells: Array, valid: Array, carry: tuple[Rows]) -> tuple[Rows]:
        rows = log.DEATHS.words(
            cell=cells,
            id=organisms.number.take(cells),
            tick=tick.take(cells),
            cause=cause[cells],
            energy=organisms.energy[cells],
            food=organisms.eaten[cells],
        )
        return (log.append(carry[0], rows, valid),)

    return log.for_each(cause >= 0, (deaths,), note)[0]


def _inherit(
    law: Law, world: World, births: Births, keys: Streams, listed: Rows
) -> tuple[Organisms, Rows]:
    """Write genomes and notes of the newborn, and list their births."""
    organisms, worlds = world
    before = (organisms.genome, organisms.notes)

    def one_batch(cells: Array, valid: Array, carry: tuple) -> tuple:
        genome, notes, listed = carry
        # A replaced parent's genome may be overwritten by then; elsewhere parents outlive births,
        # and reading the arrays that are written spares a copy of all genomes.
        parents = before if law.placement.rule == "replacing" else (genome, notes)
        of, parent = _birth(law, worlds, births, keys, cells), births.parent[cells]
        made = newborn(law, of, law.layout.flat(parents[0], parent), parents[1][parent])
        where = jnp.where(valid, cells, len(births.born))
        genome = {
            name: genome[name].at[where].set(block, mode="drop")
            for name, block in law.layout.split(made.genome).items()
        }
        notes = notes.at[where].set(made.notes, mode="drop")
        rows = _birth_rows(law, world, births, cells, of.founder, made)
        return genome, notes, log.append(listed, rows, valid)

    genome, notes, listed = log.for_each(births.born, (*before, listed), one_batch)
    return organisms._replace(genome=genome, notes=notes), listed


def _birth(law: Law, worlds: Worlds, births: Births, keys: Streams, cells: Array) -> Birth:
    """Gather what the genomes of those born in some cells (K,) depend on, beside their parents."""
    world = cells // law.cells
    return Birth(
        seed=worlds.seed.take(world),
        number=births.number.take(cells),
        draws=Draws(keys.take(world), cells % law.cells),
        founder=births.founded[cells] | (law.inheritance == "founder"),
        rates=mutation_rates(law, {name: worlds.climate[name][world] for name in law.rates}),
    )


def _birth_rows(
    law: Law, world: World, births: Births, cells: Array, founder: Array, made: Newborn
) -> Array:
    organisms, worlds = world
    parent = organisms.number.take(births.parent[cells])
    cause = jnp.where(made.mutated, BirthCause.MUTANT, BirthCause.COPY)
    return log.BIRTHS.plus(*law.mutation.notes).words(
        cell=cells,
        id=births.number.take(cells),
        parent=select(births.founded[cells], never(cells.shape), parent),
        tick=worlds.tick.take(cells // law.cells),
        cause=jnp.where(founder, BirthCause.FOUNDER, cause),
        **dict(zip(law.mutation.notes, made.notes.T, strict=True)),
    )


def _begin_lives(
    law: Law, organisms: Organisms, worlds: Worlds, births: Births, alive: Array
) -> Organisms:
    """Set everything but the genome of the newborn."""
    born = births.born
    parent_branch = organisms.branch.take(births.parent)
    founders_child = (parent_branch.hi | parent_branch.lo) == 0
    branch = select(founders_child, births.number.plus(jnp.ones_like(born)), parent_branch)
    branch = select(births.founded, zero(born.shape), branch)
    store = law.per_cell(fixed(worlds.climate["metabolism.store"]))
    return organisms._replace(
        alive=alive,
        memory=jnp.where(born[:, None], 0, organisms.memory),
        energy=jnp.where(born, store, organisms.energy),
        eaten=jnp.where(born, 0, organisms.eaten),
        born=select(born, worlds.tick.map(law.per_cell), organisms.born),
        number=select(born, births.number, organisms.number),
        branch=select(born, branch, organisms.branch),
    )


def _count(
    law: Law, worlds: Worlds, organisms: Organisms, births: Births, cause: Array, extinct: Array
) -> Worlds:
    of_cause = cause[:, None] == jnp.arange(len(Cause))
    deaths = law.by_world(of_cause).sum(axis=1, dtype=jnp.uint32)
    born = law.by_world(births.born).sum(axis=1, dtype=jnp.uint32)
    had_lived = (worlds.organism_ticks.hi | worlds.organism_ticks.lo) > 0
    total = worlds.births.plus(born)
    began_anew = never(extinct.shape)
    fixed = select(extinct, began_anew, worlds.fixed)
    fixed_births = select(extinct, began_anew, worlds.fixed_births)
    newly = _one_branch(law, organisms) & ~happened(fixed)
    return worlds._replace(
        births=total,
        deaths=worlds.deaths.plus(deaths),
        extinctions=worlds.extinctions.plus(extinct & had_lived),
        calm=jnp.where((born > 0) | (deaths.sum(axis=1) > 0), 0, worlds.calm),
        fixed=select(newly, worlds.tick, fixed),
        fixed_births=select(newly, total, fixed_births),
    )


def _one_branch(law: Law, organisms: Organisms) -> Array:
    """Whether all the living of a world descend from one child of a founder: bool (W,)."""
    alive = law.by_world(organisms.alive)
    branch = organisms.branch.map(law.by_world)
    one = largest(select(alive, branch, zero(alive.shape)), axis=1)
    same = branch.equals(one.take(np.s_[:, None])) | ~alive
    return same.all(axis=1) & ((one.hi | one.lo) > 0)
