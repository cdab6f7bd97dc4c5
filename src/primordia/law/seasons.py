"""Seasons: settings of the law that change while the run goes on, as part of the world's state."""

from collections.abc import Callable
from typing import Annotated, Literal

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.law.metabolism import ONE
from primordia.law.world import Looks, World, Worlds, ages_total
from primordia.random.wide import Wide, select, to_float, wide
from primordia.settings.base import Settings


class Schedule(Settings):
    """A setting takes a value once a tick has passed."""

    kind: Literal["schedule"] = Field(description="change at a given tick")
    setting: str = Field(min_length=1, description="the setting that changes")
    at: int = Field(ge=1, description="the first tick after this one has the new value")
    value: float = Field(ge=0, description="the new value")


class Ratchet(Settings):
    """A setting is multiplied whenever the living do well: life gets harder by a stated factor.

    Each world is looked at every so many ticks. `mean_age` is that of the living in ticks,
    `saturation` the share of cells occupied, `food` the food per organism-tick since the last look.
    """

    kind: Literal["ratchet"] = Field(description="change when the population meets a condition")
    setting: str = Field(min_length=1, description="the setting that changes")
    when: Literal["mean_age", "saturation", "food"] = Field(description="what is looked at")
    above: float = Field(ge=0, description="the setting changes if it is above this")
    factor: float = Field(gt=0, description="what the setting is then multiplied by")
    every: int = Field(ge=1, le=2**31 - 1, description="ticks from look to look")


Season = Annotated[Schedule | Ratchet, Field(discriminator="kind")]


def turn(
    seasons: tuple[Schedule | Ratchet, ...],
    governed: Callable[[str], list[str]],
    world: World,
    running: Array,
) -> tuple[Worlds, Array]:
    """Apply the seasons at the end of a tick.

    Args:
        seasons: of the law.
        governed: which settings of the climate a season's setting stands for.
        world: at the end of the tick.
        running: which worlds are, bool (W,).

    Returns:
        worlds; whose climate changed, bool (W,).
    """
    worlds = world.worlds
    changed = jnp.zeros(running.shape, bool)
    s = -1
    for season in seasons:
        if isinstance(season, Schedule):
            due = running & worlds.tick.equals(wide(season.at))
        else:
            s += 1
            look = running & (worlds.looks.wait[:, s] == 0)
            due = look & (_measure(season, s, world) > season.above)
            worlds = worlds._replace(looks=_looked(worlds, season, s, look))
        new = {
            name: _changed(worlds.climate[name], season, due) for name in governed(season.setting)
        }
        worlds = worlds._replace(climate=worlds.climate | new)
        changed = changed | due
    return worlds, changed


def ratchets(seasons: tuple[Schedule | Ratchet, ...]) -> list[Ratchet]:
    """Those that look at the world."""
    return [season for season in seasons if isinstance(season, Ratchet)]


def _measure(season: Ratchet, s: int, world: World) -> Array:
    """What the ratchet looks at, float32 (W,)."""
    worlds = world.worlds
    alive = world.organisms.alive.reshape(len(worlds.calm), -1)
    population = alive.sum(axis=1)
    if season.when == "saturation":
        return population / np.float32(alive.shape[1])
    if season.when == "mean_age":
        return to_float(ages_total(world)) / population
    lived = worlds.organism_ticks - worlds.looks.organism_ticks.take(np.s_[:, s])
    food = worlds.food - worlds.looks.food.take(np.s_[:, s])
    return to_float(food) / np.float32(ONE) / to_float(lived)


def _looked(worlds: Worlds, season: Ratchet, s: int, look: Array) -> Looks:
    looks = worlds.looks

    def note(then: Wide, now: Wide) -> Wide:
        new = select(look, now, then.take(np.s_[:, s]))
        return Wide(then.hi.at[:, s].set(new.hi), then.lo.at[:, s].set(new.lo))

    return Looks(
        wait=looks.wait.at[:, s].set(jnp.where(look, season.every, looks.wait[:, s])),
        food=note(looks.food, worlds.food),
        organism_ticks=note(looks.organism_ticks, worlds.organism_ticks),
    )


def _changed(old: Array, season: Schedule | Ratchet, due: Array) -> Array:
    """Return a setting of the climate (W,), changed in the worlds where that is due."""
    value = season.value if isinstance(season, Schedule) else old * np.float32(season.factor)
    return jnp.where(due, jnp.asarray(value, jnp.float32), old)
