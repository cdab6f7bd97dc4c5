"""Samples: rows of a world's counts, taken at fixed ticks and when a season changes its climate."""

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.law.events import Rows, sample_columns
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
    """Return the rows of `sample_columns`, uint32 (W, words)."""
    organisms, worlds = world
    energy = signed(jnp.where(organisms.alive, organisms.energy, 0))
    deaths = {
        f"deaths_{cause.name.lower()}": worlds.deaths.take(np.s_[:, cause]) for cause in Cause
    }
    return sample_columns(law.rates).words(
        world=jnp.arange(law.worlds, dtype=jnp.uint32),
        population=law.by_world(organisms.alive).sum(axis=1, dtype=jnp.uint32),
        tick=worlds.tick,
        births=worlds.births,
        **deaths,
        extinctions=worlds.extinctions,
        organism_ticks=worlds.organism_ticks,
        age_total=ages_total(world),
        oldest_age=largest(ages(world).map(law.by_world), axis=1),
        energy_total=total(energy.map(law.by_world), axis=1),
        food_total=worlds.food,
        **{name: worlds.climate[name] for name in law.rates},
    )
