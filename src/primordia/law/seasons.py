"""Seasons: changes of settings in a run. The settings' values are part of the world's state."""

from collections.abc import Callable
from itertools import count
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
    """A setting that takes a new value at the end of a given tick."""

    kind: Literal["schedule"] = Field(description="change at a given tick")
    setting: str = Field(min_length=1, description="the setting that changes")
    at: int = Field(ge=1, description="the tick after which the new value holds")
    value: float = Field(ge=0, description="the new value")


class Ratchet(Settings):
    """A setting that is multiplied when the population meets a condition, so that life gets harder.

    A ratchet measures each world at regular ticks. `mean_age` is the mean age of the living in
    ticks. `saturation` is the share of cells that are occupied. `food` is the food per
    organism-tick since the last measurement.
    """

    kind: Literal["ratchet"] = Field(description="change when the population meets a condition")
    setting: str = Field(min_length=1, description="the setting that changes")
    when: Literal["mean_age", "saturation", "food"] = Field(
        description="the quantity that is measured"
    )
    above: float = Field(
        ge=0, description="the setting changes if the quantity is above this threshold"
    )
    factor: float = Field(gt=0, description="factor by which the setting is then multiplied")
    every: int = Field(ge=1, le=2**31 - 1, description="ticks between two measurements")


Season = Annotated[Schedule | Ratchet, Field(discriminator="kind")]


def apply_seasons(
    seasons: tuple[Schedule | Ratchet, ...],
    governed: Callable[[str], list[str]],
    world: World,
    running: Array,
) -> tuple[Worlds, Array]:
    """Apply the seasons at the end of a tick.

    Args:
        seasons: the seasons of the law.
        governed: setting of a season -> the settings of the climate that it changes.
        world: the world at the end of the tick.
        running: worlds that run, bool (W,).

    Returns:
        worlds; which worlds changed their climate, bool (W,).
    """
    worlds = world.worlds
    changed = jnp.zeros(running.shape, bool)
    ratchet_numbers = count()
    for season in seasons:
        if isinstance(season, Schedule):
            due = running & worlds.tick.equals(wide(season.at))
        else:
            s = next(ratchet_numbers)
            looking = running & (worlds.looks.wait[:, s] == 0)
            due = looking & (_measure(season, s, world) > season.above)
            worlds = worlds._replace(looks=_after_look(worlds, season, s, looking))
        new = {
            name: _changed(worlds.climate[name], season, due) for name in governed(season.setting)
        }
        worlds = worlds._replace(climate=worlds.climate | new)
        changed = changed | due
    return worlds, changed


def ratchets(seasons: tuple[Schedule | Ratchet, ...]) -> list[Ratchet]:
    """Return the ratchets among seasons, in order: ratchet s has column s of `Looks`."""
    return [season for season in seasons if isinstance(season, Ratchet)]


def _measure(season: Ratchet, s: int, world: World) -> Array:
    """Return the quantity that ratchet s measures, float32 (W,)."""
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


def _after_look(worlds: Worlds, season: Ratchet, s: int, looking: Array) -> Looks:
    """Return the state of ratchets after ratchet s has measured the worlds `looking`, bool (W,)."""
    looks = worlds.looks

    def update(last: Wide, now: Wide) -> Wide:
        new = select(looking, now, last.take(np.s_[:, s]))
        return Wide(last.hi.at[:, s].set(new.hi), last.lo.at[:, s].set(new.lo))

    return Looks(
        wait=looks.wait.at[:, s].set(jnp.where(looking, season.every, looks.wait[:, s])),
        food=update(looks.food, worlds.food),
        organism_ticks=update(looks.organism_ticks, worlds.organism_ticks),
    )


def _changed(old: Array, season: Schedule | Ratchet, due: Array) -> Array:
    """Return a setting of the climate (W,), changed in the worlds where the season is due."""
    value = season.value if isinstance(season, Schedule) else old * np.float32(season.factor)
    return jnp.where(due, jnp.asarray(value, jnp.float32), old)
