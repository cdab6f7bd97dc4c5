"""Remembered moments, with which a mutation measures the change of a child's behaviour.

A moment is the input of a brain: senses and memory. Organisms remember at the ticks that are
multiples of `every`. A child begins with the moments of its parent. The tick alone decides where a
moment is stored, so chunks, interruptions and other worlds change nothing.
"""

import operator
from functools import reduce
from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.habitats.contract import Continuous, Discrete
from primordia.law.law import Law
from primordia.law.motor import argmax, outputs_of
from primordia.law.world import Remembered, World, Worlds
from primordia.mutations.contract import Change, Moments
from primordia.random.wide import modulo


def none(
    cells: int, rule: Moments | None, senses: int, memory: int, library: Any
) -> Remembered | None:
    """Return memories without moments, for empty cells, as arrays of a library; None if organisms
    remember no moments."""
    if rule is None:
        return None
    return Remembered(
        senses=library.zeros((cells, rule.kept, senses), np.float32),
        memory=library.zeros((cells, rule.kept, memory), np.float32),
        known=library.zeros((cells, rule.kept), bool),
    )


def until_due(rule: Moments, worlds: Worlds) -> Array:
    """Return the ticks until each world remembers next, int32 (W,), at least 1."""
    return rule.every - modulo(worlds.tick, rule.every)


def moment_due(law: Law, worlds: Worlds, live_worlds: Array) -> Array:
    """Return which of the worlds that ran in a tick remember at the end of the tick, bool (W,)."""
    rule = law.heredity.mutation.moments
    if rule is None:
        return jnp.zeros_like(live_worlds)
    return live_worlds & (modulo(worlds.tick, rule.every) == 0)


def remember(law: Law, world: World, senses: Array, live_worlds: Array) -> World:
    """Store a moment of every organism, in the running worlds in which a moment is due.

    Args:
        law: the law.
        world: the world at the end of a tick, with its newborn.
        senses: senses of all cells for the next tick, as from the habitat, float32 (C, S').
        live_worlds: worlds that were running in the tick, bool (W,).
    """
    organisms, rule = world.organisms, law.heredity.mutation.moments
    if rule is None or organisms.moments is None:
        return world
    senses = law.perceived(senses, organisms.energy)
    due = moment_due(law, world.worlds, live_worlds)
    place = modulo(world.worlds.tick, rule.every * rule.kept) // rule.every

    def add(moments: Remembered) -> Remembered:
        cells = jnp.arange(len(organisms.alive))
        where = law.per_cell(jnp.where(due, place, rule.kept))  # indices beyond the end are dropped
        return Remembered(
            senses=moments.senses.at[cells, where].set(senses, mode="drop"),
            memory=moments.memory.at[cells, where].set(organisms.memory, mode="drop"),
            known=moments.known.at[cells, where].set(organisms.alive, mode="drop"),
        )

    moments = lax.cond(due.any(), add, lambda moments: moments, organisms.moments)
    return world._replace(organisms=organisms._replace(moments=moments))


def change_in(law: Law, moments: Remembered, parents: Array) -> Change:
    """Return a function of genomes. It returns how far their behaviour differs from the parents'
    behaviour in the parents' moments.

    For discrete actions it is the share of moments with another choice. For continuous actions it
    is the root mean square change of the outputs, where each change counts as 1 at most. For an
    action with parts of both kinds, the larger of the two changes is returned. The change is
    infinite for a parent without moments, since nothing is known about its children.

    Args:
        law: the law.
        moments: moments of K parents.
        parents: genomes of the parents, float32 (K, P).
    """
    before = _outputs(law, moments, parents)

    def change(genomes: Array) -> Array:
        after = _outputs(law, moments, genomes)
        choices = [own for part, own in outputs_of(law.action) if isinstance(part, Discrete)]
        vectors = [own for part, own in outputs_of(law.action) if isinstance(part, Continuous)]
        changes = []
        if choices:
            changes.append(_chosen_otherwise(moments.known, before, after, choices))
        if vectors:
            old, new = (
                jnp.concatenate([each[..., own] for own in vectors], axis=-1)
                for each in (before, after)
            )
            changes.append(_moved(moments.known, old, new))
        return reduce(jnp.maximum, changes)

    return change


def _chosen_otherwise(known: Array, before: Array, after: Array, choices: list[slice]) -> Array:
    """Return the share of known moments (K, R) in which the choice of a discrete part differs, (K,)."""
    other = [argmax(_flat(after)[:, own]) != argmax(_flat(before)[:, own]) for own in choices]
    return _share(
        jnp.where(known, reduce(operator.or_, other).reshape(known.shape), 0).sum(1), known
    )


def _moved(known: Array, before: Array, after: Array) -> Array:
    """Return the root mean square change of outputs in known moments, (K,) from (K, R, A) and (K, R)."""
    size = before.shape[-1]
    # Squares, at most 1 each, are summed as whole numbers, so that the order of the sum is irrelevant.
    finest = 2 ** (30 - (known.shape[1] * size - 1).bit_length())
    square = jnp.square(after - before)
    square = jnp.where(square < 1, square, 1) * np.float32(finest)  # a NaN counts as 1 too
    counted = jnp.where(known[..., None], square, 0).astype(jnp.int32)
    total = _share(counted.sum(axis=(1, 2)), known)
    return jnp.sqrt(total / np.float32(finest * size))


def _share(count: Array, known: Array) -> Array:
    """Return counts (K,) divided by the number of known moments, float32; infinite without moments."""
    of = known.sum(axis=1)
    return jnp.where(of > 0, count.astype(jnp.float32) / jnp.maximum(of, 1), jnp.inf)


def _flat(values: Array) -> Array:
    """Return values (K, R, ...) as (K R, ...). A brain without memory has none in its last axis."""
    return values.reshape(values.shape[0] * values.shape[1], *values.shape[2:])


def _outputs(law: Law, moments: Remembered, genomes: Array) -> Array:
    """Return the outputs of K brains (K, P) in R moments each: float32 (K, R, A)."""
    count, each = moments.known.shape
    blocks = {
        name: jnp.repeat(block, each, axis=0)
        for name, block in law.heredity.layout.split(genomes).items()
    }
    _, output = law.brain(blocks, _flat(moments.memory), _flat(moments.senses))
    return output.reshape(count, each, -1)
