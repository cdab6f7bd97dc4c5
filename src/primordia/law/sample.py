"""Samples: rows of a world's counts, taken at fixed ticks and when a season changes its climate."""

import jax.numpy as jnp
from jax import Array, lax

from primordia.law.events import TOTALS, Rows
from primordia.law.law import Law
from primordia.law.world import World, ages, ages_total
from primordia.random.wide import largest, signed, total


def note_samples(law: Law, world: World, due: Array, samples: Rows) -> Rows:
    """Append a row for each world whose sample is due, bool (W,)."""
    rows = _rows(law, world)
    index = samples.filled + jnp.cumsum(due, dtype=jnp.int32) - 1
    index = jnp.where(due, index, len(samples.rows))
    written = samples.rows.at[index].set(rows, mode="drop")
    return Rows(written, samples.filled + due.sum(dtype=jnp.int32))


def _rows(law: Law, world: World) -> Array:
    """Return the rows of `sample_columns`, uint32 (W, words).

    Totals are put together as two arrays, since XLA makes a kernel of each column that is put into a
    row by itself: 24 of 220 in a small world.
    """
    organisms, worlds = world
    energy = signed(jnp.where(organisms.alive, organisms.energy, 0))
    totals = (
        worlds.tick,
        worlds.births,
        worlds.deaths,
        worlds.extinctions,
        worlds.organism_ticks,
        ages_total(world),
        largest(ages(world).map(law.by_world), axis=1),
        total(energy.map(law.by_world), axis=1),
        worlds.food,
    )
    high, low = map(jnp.column_stack, zip(*totals, strict=True))
    population = law.by_world(organisms.alive).sum(axis=1, dtype=jnp.uint32)
    rates = jnp.stack([worlds.climate[name] for name in law.rates], axis=1)
    return jnp.column_stack(
        (
            jnp.arange(law.worlds, dtype=jnp.uint32),
            population,
            jnp.stack((high, low), axis=2).reshape(law.worlds, 2 * len(TOTALS)),
            lax.bitcast_convert_type(rates, jnp.uint32),
        )
    )
