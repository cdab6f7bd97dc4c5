"""A run in numbers: how far its worlds have come, who lives in them, and their digests."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from primordia.law.metabolism import break_even
from primordia.law.world import Cause
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import NEVER, read_count
from primordia.runs.digest import digests

TALLY = "bodies.tally"


def info(run: Archive) -> dict[str, Any]:
    """A run in one object.

    `saturation` and `fixation` are None, or the tick and the births (founders counted) at which they
    came. Ages are those of the living, in ticks; so is what the habitat counts (`tallies`).
    `break_even` is the food, a tick and a second, that keeps energy where it is, and `tries_per_life`
    how often an organism tries to copy itself in a life of mean length, as the world stands now. Below
    one a lineage cannot last. With one world its fields also stand at the top.
    """
    config, last = run.config, run.last
    each = digests(last.digests, run.state, config.seeds)
    worlds = [_world(run, world, digest) for world, digest in enumerate(each)]
    whole = {
        "task": config.task,
        "inheritance": config.inheritance,
        "cells": config.cells,
        "seeds": config.seeds,
        "worlds": worlds,
        "wall_s": last.progress.wall_s,
        "exact": last.progress.exact,
        "limits": last.progress.limits,
        "versions": run.versions,
    }
    return whole if config.seeds > 1 else {**worlds[0], **whole}


def _world(run: Archive, world: int, digest: str) -> dict[str, Any]:
    config, arrays = run.config, run.state

    def counted(name: str) -> Any:
        return read_count(arrays, f"world.worlds.{name}")[world].tolist()

    here = slice(world * config.cells, (world + 1) * config.cells)
    alive = arrays["world.organisms.alive"][here]
    tick = counted("tick")
    ages = tick - read_count(arrays, "world.organisms.born")[here][alive].astype(np.int64)
    deaths = counted("deaths")
    found = {
        "seed": config.seed + world,
        "ticks": tick,
        "alive": int(alive.sum()),
        "births": counted("births"),
        "deaths": sum(deaths),
        "deaths_by_cause": dict(zip((cause.label for cause in Cause), deaths, strict=True)),
        "extinctions": counted("extinctions"),
        "cell_ticks": tick * config.cells,
        "organism_ticks": counted("organism_ticks"),
        "mean_age": float(ages.mean()) if len(ages) else None,
        "oldest_age": int(ages.max()) if len(ages) else None,
        "tries_per_life": _tries(_climate(arrays, world)["replication"], counted),
        "saturation": _moment(counted("saturated"), counted("saturated_births")),
        "fixation": _moment(counted("fixed"), counted("fixed_births")),
        "digest": digest,
    }
    if (tally := arrays.get(TALLY)) is not None and alive.any():
        found["tallies"] = _of_the_living(run.habitat.tallies, tally[here][alive])
    if config.metabolism is not None:
        found["break_even"] = _break_even(arrays, world, run.habitat.rate)
    if config.seasons:
        found["climate"] = _climate(arrays, world)
    return found


def _tries(replication: float, counted: Callable[[str], int]) -> float | None:
    births = counted("births")
    return replication * counted("organism_ticks") / births if births else None


def _moment(tick: int, births: int) -> dict[str, int] | None:
    return None if tick == NEVER else {"tick": tick, "births": births}


def _of_the_living(names: tuple[str, ...], tally: np.ndarray) -> dict[str, dict[str, float]]:
    """Median and best of what the habitat counts."""
    return {
        name: {"median": float(np.median(column)), "best": int(column.max())}
        for name, column in zip(names, tally.T, strict=True)
    }


def _break_even(
    arrays: Mapping[str, np.ndarray], world: int, rate: float | None
) -> dict[str, float | None]:
    """Food that keeps energy where it is; None where none does, or without seconds."""
    climate = _climate(arrays, world)
    each = break_even(climate["metabolism.drain"], climate["metabolism.gain"])
    second = each * rate if each is not None and rate is not None else None
    return {"food_per_tick": each, "food_per_second": second}


def _climate(arrays: Mapping[str, np.ndarray], world: int) -> dict[str, float]:
    return {
        name.removeprefix("world.worlds.climate."): arrays[name][world].tolist()
        for name in arrays
        if name.startswith("world.worlds.climate.")
    }
