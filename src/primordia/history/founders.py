"""Alternative founders of a run's world, made by its law with keys that no run uses."""

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia import device
from primordia.compiled import shared
from primordia.history.births import recorded
from primordia.history.climate import PastClimate
from primordia.law.heredity import Heredity
from primordia.law.world import Climate
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide
from primordia.runs.records import Records

AT_ONCE = 128
"""Founders made in one call; the number is fixed, since JAX compiles for every new shape."""


def founders(run: Records, world: int, count: int) -> np.ndarray:
    """Return the genomes of different founders, float32 (count, P).

    The founders are made in the climate that the world began with. If the run has ancestors, the
    founders take the ancestors' genomes in turn.
    """
    device.prepare()
    make = shared(_made, run.heredity)
    seed = stream(wide(run.world_seeds[[world]]), Purpose.CONTROL, wide([0]))
    climate = PastClimate(run).of_worlds(np.full(AT_ONCE, world), np.zeros(AT_ONCE, np.int64))
    parts = [
        make(seed, wide(first + np.arange(AT_ONCE)), climate) for first in range(0, count, AT_ONCE)
    ]
    return np.concatenate([np.asarray(part) for part in parts])[:count]


def _made(heredity: Heredity, seed: Wide, numbers: Wide, climate: Climate) -> Array:
    """Return the genomes of founders by their numbers (K,), float32 (K, P)."""
    count = numbers.lo.shape[0]
    seeds = seed.map(lambda word: jnp.broadcast_to(word, (count,)))
    marks = jnp.zeros(count, jnp.int32), jnp.ones(count, bool)
    birth = recorded(heredity, (seeds, numbers, numbers), marks, climate)
    parents = jnp.zeros((count, heredity.layout.length), jnp.float32)
    notes = jnp.zeros((count, len(heredity.mutation.notes)), jnp.int32)
    return heredity.rebuild_genomes(birth, parents, notes)
