"""Measurements of an environment in lives with random actions."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.habitats.bodies import MADE, fresh_bodies, random_actions
from primordia.habitats.gymnax.habitat import Body, Gymnax
from primordia.random import trials

BODIES, TICKS = MADE, 500
"""Number of lives, and largest number of ticks of each."""


@dataclass(frozen=True)
class Measured:
    """The results for an environment."""

    lifespan: float
    """mean ticks of the lives; an unfinished life counts with its length so far"""
    ended: int
    """number of lives that the environment ended"""
    largest: np.ndarray
    """largest absolute value of each number of the observation, float32 (S,)"""
    faults: list[str]
    """the faults, each in a sentence"""


class _Seen(NamedTuple):
    """The record of a tick of the living bodies."""

    alive: Array
    """before the tick, bool (N,)"""
    done: Array
    """bool (N,)"""
    largest: Array
    """float32 (S,)"""
    inside: Array
    """whether all observations are in their space, bool ()"""
    finite: Array
    rewarded: Array
    """whether all rewards are finite, bool ()"""


def measure(habitat: Gymnax) -> Measured:
    """Let bodies act at random, and trace the environment's functions twice."""
    repeats = habitat.simulator.repeats()  # first, since it clears JAX's caches
    born = fresh_bodies(habitat, trials.words(0, BODIES, habitat.words))
    actions = random_actions(habitat.action, TICKS, BODIES)
    seen = jax.tree.map(np.asarray, shared(_lived, habitat)(born, actions))
    wrong = {
        "an observation is not finite": not seen.finite.all(),
        "an observation is outside the declared space": not seen.inside.all(),
        "a reward is not finite": not seen.rewarded.all(),
        "step changes the state that it is given": habitat.simulator.changes_state(),
        "functions of the environment differ when traced again: they take randomness from outside JAX, "
        "or keep something between calls": not repeats,
    }
    return Measured(
        lifespan=seen.alive.sum(axis=0).mean(),
        ended=int((seen.alive & seen.done).any(axis=0).sum()),
        largest=seen.largest.max(axis=0),
        faults=[line for line, holds in wrong.items() if holds],
    )


def _lived(habitat: Gymnax, born: Body, actions: Array) -> _Seen:
    """Return the record of each tick of the lives of N fresh bodies."""

    def tick(carry: tuple[Body, Array], action: Array) -> tuple[tuple[Body, Array], _Seen]:
        bodies, alive = carry
        bodies, values = habitat.tick(bodies, action)
        seen = _seen(habitat, values, alive)
        return (bodies, alive & ~seen.done), seen

    return lax.scan(tick, (born, jnp.ones(BODIES, bool)), actions)[1]


def _seen(habitat: Gymnax, values: dict[str, Any], alive: Array) -> _Seen:
    observed = jnp.where(alive[:, None], values["obs"], 0)
    reward = jnp.where(alive, values["reward"], 0)
    return _Seen(
        alive,
        values["done"],
        jnp.abs(observed).max(axis=0),
        (habitat.senses.declared(values["obs"]) | ~alive).all(),
        jnp.isfinite(observed).all(),
        jnp.isfinite(reward).all(),
    )
