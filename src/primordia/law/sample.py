"""Samples: a row a world at fixed ticks, and whenever a season changes its climate."""

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.law.events import Rows
from primordia.law.world import Cause, Climate, World, ages, ages_total
from primordia.random.wide import Wide, largest, signed, total

WIDE_COLUMNS = (
    "tick",
    "births",
    *(f"deaths_{cause.name.lower()}" for cause in Cause),
    "extinctions",
    "organism_ticks",
    "age_total",
    "oldest_age",
    "energy_total",
    "food_total",
)
"""Columns of a sample with 64 bits. Totals are over the living; food over all that ever lived.
Energy and food are in 1/1024 units, two's complement."""


def climate_columns(blocks: list[str]) -> list[str]:
    """Names of the climate's columns, by the settings they stand for."""
    of_blocks = [f"mutation.{name}.{each}" for each in ("probability", "scale") for name in blocks]
    rates = [f"metabolism.{name}" for name in ("store", "drain", "gain", "effort_cost", "cap")]
    return ["replication", "hazard", *of_blocks, *rates]


def climate_values(climate: Climate) -> list[Array]:
    """The values of those columns, each float32 (W,)."""
    of_blocks = [*climate.mutation_probability.T, *climate.mutation_scale.T]
    return [climate.replication, climate.hazard, *of_blocks, *climate.metabolism]


def width(blocks: list[str]) -> int:
    """How many words a sample has: world, population, pairs, climate."""
    return 2 + 2 * len(WIDE_COLUMNS) + len(climate_columns(blocks))


def note_samples(world: World, due: Array, samples: Rows) -> Rows:
    """Append a row for each world that is due, bool (W,)."""
    rows = jnp.stack(_columns(world), axis=1)
    place = samples.filled + jnp.cumsum(due, dtype=jnp.int32) - 1
    place = jnp.where(due, place, len(samples.rows))
    written = samples.rows.at[place].set(rows, mode="drop")
    return Rows(written, samples.filled + due.sum(dtype=jnp.int32))


def _columns(world: World) -> list[Array]:
    worlds, organisms = world.worlds, world.organisms
    count = worlds.calm.size
    alive = organisms.alive.reshape(count, -1)

    def by_world(value: Wide) -> Wide:
        return value.map(lambda words: words.reshape(count, -1))

    energy = signed(jnp.where(organisms.alive, organisms.energy, 0))
    pairs = [
        worlds.tick,
        worlds.births,
        *(worlds.deaths.take(np.s_[:, cause]) for cause in Cause),
        worlds.extinctions,
        worlds.organism_ticks,
        ages_total(world),
        largest(by_world(ages(world)), axis=1),
        total(by_world(energy), axis=1),
        worlds.food,
    ]
    words = [word for pair in pairs for word in pair]
    values = [lax.bitcast_convert_type(v, jnp.uint32) for v in climate_values(worlds.climate)]
    head = [jnp.arange(count, dtype=jnp.uint32), alive.sum(axis=1, dtype=jnp.uint32)]
    return [*head, *words, *values]
