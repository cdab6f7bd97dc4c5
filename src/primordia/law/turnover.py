"""Turnover: the dead are removed, the newborn are added, and extinct worlds begin again.

Turnover runs only in ticks in which an organism dies or may be born. The weights of genomes are
handled once for each birth. All other work is cheap enough to be done for all cells at once.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.habitats.bodies import select_bodies
from primordia.law import events as log
from primordia.law.events import Events, Rows
from primordia.law.heredity import Birth, Newborn
from primordia.law.law import Law
from primordia.law.life import first_memory
from primordia.law.metabolism import to_fixed_point
from primordia.law.moments import change_in
from primordia.law.tick import Fates
from primordia.law.world import BirthCause, Cause, Organisms, Remembered, World, Worlds
from primordia.mutations.contract import Draws
from primordia.random.keys import Purpose, Streams, below, bits, bits_if, streams
from primordia.random.wide import Wide, happened, largest, never, select, zero


class Births(NamedTuple):
    """The births of one tick, (C,)."""

    newborn: Array
    """bool: an organism is born in this cell"""
    founded: Array
    """bool: the newborn is a founder of genesis, without a parent"""
    parent: Array
    """int32, cell of the parent (on the axis of all worlds); it has no meaning for founders"""
    number: Wide
    """birth number within the world"""
    survives: Array
    """bool: an organism that was alive before the tick lives on in this cell"""
    energy: Array
    """int32, fixed point: what a newborn in this cell begins with"""


class _Inherited(NamedTuple):
    """The arrays that organisms inherit, as in `Organisms`; first axis C, or the newborn."""

    genome: Genome
    notes: Array
    moments: Remembered | None


def birth_keys(law: Law, worlds: Worlds) -> Streams:
    """Return the keys of the turnover at the end of the present tick, (W,)."""
    own = () if law.heredity.recombination is None else (Purpose.MATE,)
    purposes = (Purpose.PLACE, Purpose.GENESIS, *own, *law.heredity.purposes)
    return streams(worlds.seed, worlds.tick, *purposes)


def turnover(
    law: Law,
    world: World,
    events: Events,
    running: Array,
    fates: Fates,
    keys: Streams,
) -> tuple[World, Events, Array]:
    """Carry out the deaths and births of one tick.

    Args:
        law: the law.
        world: the world; `worlds.tick` is the number of the tick that ends.
        events: the lists to which births and deaths are added.
        running: worlds that run, bool (W,).
        fates: the fates of the tick.
        keys: `birth_keys` of the tick.

    Returns:
        world, events, cells of the newborn (bool (C,)).
    """
    parent = _place(law, world.worlds, keys[Purpose.PLACE], fates.wants, world.organisms.alive)
    organisms, worlds = _endow(law, world, parent, fates.endowment)
    cause = fates.cause
    cause = jnp.where(organisms.alive & (parent >= 0) & (cause < 0), Cause.REPLACED, cause)
    alive = (organisms.alive & (cause < 0)) | (parent >= 0)
    extinct = running & ~law.by_world(alive).any(axis=1)
    founded = _genesis(law, keys[Purpose.GENESIS], extinct).ravel()
    survives = organisms.alive & (cause < 0)
    births = _births(law, worlds, parent, founded, survives, fates.endowment)

    events = events._replace(deaths=_note_deaths(law, organisms, worlds, cause, events.deaths))
    organisms, listed = _inherit(law, World(organisms, worlds), births, keys, events.births)
    organisms = _begin_lives(law, organisms, worlds, births, alive | founded)
    worlds = _count(law, worlds, organisms, births, cause, extinct)
    return World(organisms, worlds), events._replace(births=listed), births.newborn


def _place(law: Law, worlds: Worlds, key: Wide, wants: Array, alive: Array) -> Array:
    """Return the cell of each newborn's parent (on the axis of all worlds), or -1: int32 (C,)."""
    key, cells = key.take(np.s_[:, None]), jnp.arange(law.cells)[None]

    def draw(number: Array) -> Wide:
        return bits_if(wants.any(), key, cells, number)

    chance = None
    if law.islands.count > 1:
        chance = law.by_world(law.in_cells(worlds.climate)["placement.migration"])
    wants, alive = law.by_world(wants), law.by_world(alive)
    parent = law.placement.parents(draw, wants, alive, law.islands, chance)
    first = law.cells * jnp.arange(law.worlds, dtype=jnp.int32)[:, None]
    return jnp.where(parent >= 0, parent + first, -1).ravel()


def _endow(law: Law, world: World, parent: Array, endowment: Array | None) -> World:
    """Let each parent, int32 (C,) or -1 as from `_place`, pay the endowment of its child.

    A parent has at most one child in a tick.
    """
    organisms, worlds = world
    if endowment is None or worlds.acts is None:
        return world
    cells = len(parent)
    index = jnp.where(parent >= 0, parent, cells)
    pays = jnp.zeros(cells, bool).at[index].set(True, mode="drop")
    given = jnp.where(pays, endowment, 0)
    return World(
        organisms._replace(energy=organisms.energy - given),
        worlds._replace(acts=worlds.acts.born(law.by_world(given))),
    )


def _genesis(law: Law, key: Wide, extinct: Array) -> Array:
    """Return the cells in which founders are born: bool (W, N)."""
    if law.genesis == "fill":
        return jnp.broadcast_to(extinct[:, None], (law.worlds, law.cells))
    chosen = below(bits(key, jnp.zeros_like(key.lo)).hi, law.cells)
    return extinct[:, None] & (jnp.arange(law.cells)[None] == chosen[:, None])


def _births(
    law: Law,
    worlds: Worlds,
    parent: Array,
    founded: Array,
    survives: Array,
    endowment: Array | None,
) -> Births:
    newborn = (parent >= 0) | founded
    rank = jnp.cumsum(law.by_world(newborn), axis=1, dtype=jnp.int32).ravel() - 1
    number = worlds.births.map(law.per_cell).plus(jnp.maximum(rank, 0))
    energy = to_fixed_point(law.in_cells(worlds.climate)["metabolism.store"])
    if endowment is not None:
        energy = jnp.where(parent >= 0, endowment[jnp.maximum(parent, 0)], energy)
    return Births(newborn, founded, jnp.maximum(parent, 0), number, survives, energy)


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
    """Write the genomes and notes of the newborn, and list their births."""
    organisms, worlds = world
    before = _Inherited(organisms.genome, organisms.notes, organisms.moments)

    def one_batch(cells: Array, valid: Array, carry: tuple) -> tuple:
        now, listed = carry
        # An earlier batch may have overwritten the genome of a replaced parent. Under other rules parents
        # outlive births, and reading the arrays that are written saves a copy of all genomes.
        past = before if law.placement.rule == "replacing" else now
        birth, parent = _birth(law, worlds, births, keys, cells), births.parent[cells]
        parents = law.heredity.layout.flat(past.genome, parent)
        mate = _mates(law, births, keys, cells, birth.founder)
        if mate is not None:
            mates = law.heredity.layout.flat(past.genome, jnp.maximum(mate, 0))
            parents = law.heredity.recombined(birth, parents, mates, mate >= 0)
        of = cells if law.heredity.mutation.notes_from == "cell" else parent
        moments = jax.tree.map(lambda leaf: leaf[parent], past.moments)
        change = None if moments is None else change_in(law, moments, parents)
        newborn = law.heredity.make_newborn(birth, parents, past.notes[of], change)
        own = _Inherited(
            law.heredity.layout.split(newborn.genome),
            newborn.notes,
            # A founder's parent is any cell, perhaps of another world, so its moments are zeros.
            select_bodies(birth.founder, jax.tree.map(jnp.zeros_like, moments), moments),
        )
        where = jnp.where(valid, cells, len(births.newborn))
        now = jax.tree.map(lambda all_, new: all_.at[where].set(new, mode="drop"), now, own)
        rows = _birth_rows(law, world, births, cells, mate, birth.founder, newborn)
        return now, log.append(listed, rows, valid)

    inherited, listed = log.for_each(births.newborn, (before, listed), one_batch)
    return organisms._replace(**inherited._asdict()), listed


def _birth(law: Law, worlds: Worlds, births: Births, keys: Streams, cells: Array) -> Birth:
    """Return the inputs of heredity for the newborn in some cells (K,), except their parents' genomes."""
    world = cells // law.cells
    return Birth(
        seed=worlds.seed.take(world),
        number=births.number.take(cells),
        draws=Draws(keys.take(world), cells % law.cells),
        founder=_founders(law, births)[cells],
        rates=law.heredity.rates(law.in_cells(worlds.climate, cells)),
    )


def _founders(law: Law, births: Births) -> Array:
    """Return which newborn inherit nothing, bool (C,): without a parent, or without heredity."""
    return births.founded | (law.heredity.inheritance == "founder")


def _mates(law: Law, births: Births, keys: Streams, cells: Array, founder: Array) -> Array | None:
    """Return the cell of each newborn's mate on the axis of all worlds, or -1: int32 (K,).

    The result is None without recombination.
    """
    if law.heredity.recombination is None:
        return None
    world, cell = cells // law.cells, cells % law.cells
    near = law.placement.near(cell, law.islands) & law.by_world(births.survives)[world]
    is_parent = jnp.arange(law.cells) == (births.parent[cells] % law.cells)[:, None]
    word = bits(keys[Purpose.MATE].take(world), cell)
    chosen = law.heredity.recombination.mates(word, near & ~is_parent & ~founder[:, None])
    return jnp.where(chosen >= 0, chosen + law.cells * world, -1)


def _birth_rows(
    law: Law,
    world: World,
    births: Births,
    cells: Array,
    mate: Array | None,
    founder: Array,
    newborn: Newborn,
) -> Array:
    organisms, worlds = world
    parent = organisms.number.take(births.parent[cells])
    cause = jnp.where(newborn.mutated, BirthCause.MUTANT, BirthCause.COPY)
    none = never(cells.shape)
    own: dict[str, Array | Wide] = {}
    if mate is not None:
        own["mate"] = select(mate >= 0, organisms.number.take(jnp.maximum(mate, 0)), none)
    if law.act is not None:
        own["endowment"] = births.energy[cells]
    return log.births_of(law).words(
        cell=cells,
        id=births.number.take(cells),
        parent=select(births.founded[cells], none, parent),
        tick=worlds.tick.take(cells // law.cells),
        cause=jnp.where(founder, BirthCause.FOUNDER, cause),
        **own,
        **dict(zip(law.heredity.mutation.notes, newborn.notes.T, strict=True)),
    )


def _begin_lives(
    law: Law, organisms: Organisms, worlds: Worlds, births: Births, alive: Array
) -> Organisms:
    """Set all arrays of the newborn except genome and notes."""
    newborn = births.newborn
    parent_branch = organisms.branch.take(births.parent)
    founders_child = (parent_branch.hi | parent_branch.lo) == 0
    branch = select(founders_child, births.number.plus(jnp.ones_like(newborn)), parent_branch)
    branch = select(births.founded, zero(newborn.shape), branch)
    memory = first_memory(law, organisms.memory[births.parent], _founders(law, births))
    return organisms._replace(
        alive=alive,
        memory=jnp.where(newborn[:, None], memory, organisms.memory),
        energy=jnp.where(newborn, births.energy, organisms.energy),
        eaten=jnp.where(newborn, 0, organisms.eaten),
        born=select(newborn, worlds.tick.map(law.per_cell), organisms.born),
        number=select(newborn, births.number, organisms.number),
        branch=select(newborn, branch, organisms.branch),
    )


def _count(
    law: Law, worlds: Worlds, organisms: Organisms, births: Births, cause: Array, extinct: Array
) -> Worlds:
    """Count the births, deaths and extinctions of the tick, and record fixation."""
    of_cause = cause[:, None] == jnp.arange(len(Cause))
    deaths = law.by_world(of_cause).sum(axis=1, dtype=jnp.uint32)
    births_now = law.by_world(births.newborn).sum(axis=1, dtype=jnp.uint32)
    had_lived = (worlds.organism_ticks.hi | worlds.organism_ticks.lo) > 0
    total = worlds.births.plus(births_now)
    not_fixed = never(extinct.shape)  # an extinct world begins again
    fixed = select(extinct, not_fixed, worlds.fixed)
    fixed_births = select(extinct, not_fixed, worlds.fixed_births)
    newly = _one_branch(law, organisms) & ~happened(fixed)
    return worlds._replace(
        births=total,
        deaths=worlds.deaths.plus(deaths),
        extinctions=worlds.extinctions.plus(extinct & had_lived),
        calm=jnp.where((births_now > 0) | (deaths.sum(axis=1) > 0), 0, worlds.calm),
        fixed=select(newly, worlds.tick, fixed),
        fixed_births=select(newly, total, fixed_births),
    )


def _one_branch(law: Law, organisms: Organisms) -> Array:
    """Return whether all the living of a world descend from one child of a founder: bool (W,)."""
    alive = law.by_world(organisms.alive)
    branch = organisms.branch.map(law.by_world)
    last_branch = largest(select(alive, branch, zero(alive.shape)), axis=1)
    same = branch.equals(last_branch.take(np.s_[:, None])) | ~alive
    return same.all(axis=1) & ((last_branch.hi | last_branch.lo) > 0)
