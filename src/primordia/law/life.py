"""One tick of N organisms without neighbours: brains think, motors act, outcomes are judged.

Both engines, relived lives and evaluations use these functions, so an organism's tick has the same
rules everywhere. The modules `tick` and `turnover` add neighbours, worlds, accidents and births.
"""

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.habitats.bodies import not_finite
from primordia.habitats.contract import Bodies, Outcome
from primordia.law.act import Tries
from primordia.law.law import Law
from primordia.law.metabolism import Rates, add, food_eaten, metabolise, to_fixed_point
from primordia.law.motor import chosen
from primordia.law.world import Cause
from primordia.mutations.noise import noise_index
from primordia.random.gaussian import quantiles
from primordia.random.wide import Wide

BODILY = (Cause.TIME_LIMIT, Cause.STARVED, Cause.FATAL, Cause.FAULT)
"""Causes of death that come from brain, body or energy. If several hold, the last one is recorded."""


class Thought(NamedTuple):
    """The results of brains and motors for one tick's senses; first axis N."""

    memory: Array
    """float32 (N, M)"""
    action: Array
    """int32 (N,) or float32 (N, K); see `habitats.contract.Action`"""
    faulty: Array
    """bool (N,): an output of the brain, or the energy that it spends, is not finite"""
    spent: Array | None = None
    """float32 (N,): energy that thinking costs; None: it is free; see `Brain.spent`"""
    copying: Array | None = None
    """float32 (N, `Act.outputs`): outputs that decide about copies; None unless replication is an act"""


class Vitals(NamedTuple):
    """Energy of organisms, and food of their whole lives: each int32 (N,), fixed point."""

    energy: Array
    eaten: Array


def first_memory(law: Law, parents: Array, founder: Array) -> Array:
    """Return the memories with which N organisms begin, float32 (N, M).

    Args:
        law: the law.
        parents: memories of their parents at the end of the tick of birth, float32 (N, M).
        founder: whether they are founders, which begin with 0, bool (N,).
    """
    passed_on = law.brain.passed_on(parents, law.senses, law.outputs)
    none = jnp.zeros_like(parents)
    return none if passed_on is None else jnp.where(founder[:, None], none, passed_on)


def inherits_memory(law: Law) -> bool:
    """Return whether the first memory of a child depends on its parent's memory."""
    parents = jnp.zeros((1, law.memory), jnp.float32)
    return law.brain.passed_on(parents, law.senses, law.outputs) is not None


def think(
    law: Law, genome: Genome, memory: Array, senses: Array, key: Wide, cell: Array
) -> Thought:
    """Advance brains and motors by one tick.

    Args:
        law: the law.
        genome: blocks of weights, float32 (N, *shape) each.
        memory: float32 (N, M).
        senses: what organisms perceive, float32 (N, S), as from `Law.perceived`.
        key: key of each organism's motor in this tick, (N,).
        cell: each organism's cell within its world, int32 (N,).
    """
    after, output = law.brain(genome, memory, senses)
    faulty, copying = (~jnp.isfinite(output)).any(axis=1), None
    spent = law.brain.spent(memory, after, law.senses, law.outputs)
    if spent is not None:
        faulty = faulty | ~jnp.isfinite(spent)
    if law.act is not None:
        output, copying = output[:, : law.action.size], output[:, law.action.size :]
    return Thought(after, act(law, key, cell, output), faulty, spent, copying)


def act(law: Law, key: Wide, cell: Array, output: Array) -> Array:
    """Return the actions for the outputs of brains, float32 (N, A); see `think`."""
    if law.motor.kind == "direct":
        return chosen(law.action, output, output)
    table = jnp.asarray(quantiles() * np.float32(law.motor.sd))
    return chosen(law.action, output, output + table[noise_index(key, cell, law.action.size)])


def judge(
    law: Law,
    vitals: Vitals,
    faulty: Array,
    bodies: Bodies,
    outcome: Outcome,
    rates: Rates,
    spent: Array | None = None,
) -> tuple[Vitals, Array]:
    """Judge a tick in the habitat for N organisms: they eat, spend energy, and may die.

    Args:
        law: the law.
        vitals: energy and food before the tick.
        faulty: `Thought.faulty` of the tick, bool (N,).
        bodies: the bodies after the tick, or the senses if the habitat is on the host.
        outcome: the habitat's outcome, (N,) each.
        rates: settings of the metabolism in each organism's world; not used without a metabolism.
        spent: `Thought.spent` of the tick.

    Returns:
        energy and food after the tick; the cause of death, one of BODILY, or -1: int32 (N,).
    """
    energy, eaten = vitals
    if law.metabolism is not None:
        energy = metabolise(energy, outcome.food, outcome.effort, rates, outcome.capacity)
        if spent is not None:
            energy = add(energy, -to_fixed_point(spent))
    if outcome.food is not None:
        eaten = add(eaten, food_eaten(outcome.food))
    cause = jnp.full(faulty.shape, -1, jnp.int32)
    if outcome.expired is not None:
        cause = jnp.where(outcome.expired, Cause.TIME_LIMIT, cause)
    if law.metabolism is not None:
        cause = jnp.where(energy <= 0, Cause.STARVED, cause)
    cause = jnp.where(outcome.fatal, Cause.FATAL, cause)
    fault = faulty | has_failed(bodies, outcome)
    return Vitals(energy, eaten), jnp.where(fault, Cause.FAULT, cause)


def try_to_copy(
    law: Law, vitals: Vitals, cause: Array, copying: Array, rates: Rates
) -> tuple[Vitals, Tries]:
    """Let the survivors of a tick try to copy themselves, if replication is an act.

    Args:
        law: the law, with an act.
        vitals: energy and food after the tick.
        cause: cause of death or -1, as from `judge`; the dead do not try.
        copying: `Thought.copying` of the tick.
        rates: as in `judge`.

    Returns:
        energy and food after the price is paid; the tries.
    """
    assert law.act is not None
    assert rates.price is not None
    tries = law.act.tries(copying, vitals.energy, rates.price)
    tries = Tries(*(jnp.where(cause < 0, each, jnp.zeros_like(each)) for each in tries))
    return vitals._replace(energy=vitals.energy - tries.price), tries


def has_failed(bodies: Bodies, outcome: Outcome) -> Array:
    """Return which bodies failed, bool (N,): the habitat reports it, or a number is not finite."""
    failed = not_finite(bodies)
    for number in (outcome.food, outcome.effort, outcome.capacity):
        failed = failed if number is None else failed | ~jnp.isfinite(number)
    return failed if outcome.fault is None else failed | outcome.fault
