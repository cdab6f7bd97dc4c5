"""Samples: rows of a world's counts, taken at fixed ticks and when a season changes its climate."""

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.law.events import TOTALS, Rows, sample_columns
from primordia.law.law import Law
from primordia.law.world import Cause, World, ages, ages_total
from primordia.random.wide import largest, signed, total


def note_samples(law: Law, world: World, due: Array, samples: Rows) -> Rows:
    """Append a row for each world whose sample is due, bool (W,)."""
    rows = _rows(law, world)
    index = samples.filled + jnp.cumsum(due, dtype=jnp.int32) - 1
    index = jnp.where(due, index, len(samples.rows))
    written = samples.rows.at[index].set(rows, mode="drop")
    return Rows(written, samples.filled + due.sum(dtype=jnp.int32))


def _rows(law: Law, world: World) -> Array:
    organisms, worlds = world
    alive = law.by_world(organisms.alive)
    energy = signed(jnp.where(organisms.alive, organisms.energy, 0))
    totals = (
        worlds.tick,
        worlds.births,
        *(worlds.deaths.take(np.s_[:, cause]) for cause in Cause),
        worlds.extinctions,
        worlds.organism_ticks,
        ages_total(world),
        largest(ages(world).map(law.by_world), axis=1),
        total(energy.map(law.by_world), axis=1),
        worlds.food,
    )
    return sample_columns(law.rates).words(
        world=jnp.arange(law.worlds, dtype=jnp.uint32),
        population=alive.sum(axis=1, dtype=jnp.uint32),
        **dict(zip(TOTALS, totals, strict=True)),
        **worlds.climate,
    )
