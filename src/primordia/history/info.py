"""A run in numbers: ticks, births, deaths and the living of its worlds, and their digests."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from primordia.history.extinctions import extinctions_of
from primordia.history.islands import on_islands
from primordia.history.threshold import Threshold, threshold
from primordia.history.traits import of_living
from primordia.law.metabolism import ONE, break_even
from primordia.law.world import Cause
from primordia.runs.arrays import NEVER
from primordia.runs.digest import digests
from primordia.runs.records import Records

TALLY = "bodies.tally"


def info(run: Records) -> dict[str, Any]:
    """Return a run in numbers, as one dictionary in JSON's types.

    `crashes` are the extinctions after a rise; see `extinctions`. `threshold` is the error threshold
    among the later half of the births; see `threshold`.
    `saturation` and `fixation` each hold a tick and the number of births until then (founders
    included); each is None if it has not happened. `restarts` is the number of times that the run
    was resumed with bodies as at birth, since its habitat cannot save them. `damaged` holds a line
    for each newer checkpoint that is damaged, so that the numbers come from an earlier one. Ages, in
    ticks, and the habitat's counts (`tallies`) are those of the living. `break_even` holds the food
    per tick and the food per second that keep energy constant, without effort, under the present
    climate. `tries_per_life` tells how often an organism tries to copy itself in a life of mean
    length, at the present rate of replication. If the number is below one, lineages die out. If
    replication is an act, it is the mean number of tries so far, and `act` counts the tries, those that
    failed, the children, and the energy invested in them. If worlds have islands, `islands` holds the
    numbers of each; see `islands.OnIsland`. If bodies are inherited, `traits` holds median and quartiles
    of the living's traits. The fields of a single world also appear at the top level.
    """
    config, progress = run.config, run.progress
    worlds = [
        {**world, "digest": digest}
        for part in run.parts()
        for world, digest in zip(
            _worlds(part),
            digests(part.row_digests, part.state, part.config.seeds, part.config.islands),
            strict=True,
        )
    ]
    whole = {
        "task": config.task,
        "inheritance": config.inheritance,
        "cells": config.cells,
        "seeds": config.seeds,
        "worlds": worlds,
        "wall_s": progress.wall_s,
        "exact": progress.exact,
        "restarts": progress.restarts,
        "damaged": run.damaged,
        "limits": progress.limits.model_dump(),
        "versions": run.versions,
    }
    return whole if config.seeds > 1 else {**worlds[0], **whole}


def _worlds(run: Records) -> list[dict[str, Any]]:
    each = zip(extinctions_of(run).crashes.tolist(), _thresholds(run), strict=True)
    worlds = [_world(run, world, *of_records) for world, of_records in enumerate(each)]
    for island in on_islands(run):
        told = island.to_dict()
        worlds[told.pop("world")].setdefault("islands", []).append(told)
    return worlds


def _thresholds(run: Records) -> list[dict[str, Any]]:
    """Return the error threshold of each world, without the number of the world."""
    unknown = Threshold(0, None, None, None)
    found = threshold(run) + [unknown] * (run.config.seeds - run.lives.worlds)
    return [{k: value for k, value in each.to_dict().items() if k != "world"} for each in found]


def _world(run: Records, world: int, crashed: int, limit: dict[str, Any]) -> dict[str, Any]:
    config, arrays = run.config, run.state

    def counted(name: str) -> Any:
        return run.count(f"world.worlds.{name}")[world].tolist()

    here = slice(world * config.cells, (world + 1) * config.cells)
    alive = arrays["world.organisms.alive"][here]
    tick = counted("tick")
    ages = tick - run.count("world.organisms.born")[here][alive].astype(np.int64)
    deaths = counted("deaths")
    numbers = {
        "seed": int(run.world_seeds[world]),
        "ticks": tick,
        "alive": int(alive.sum()),
        "births": counted("births"),
        "deaths": sum(deaths),
        "deaths_by_cause": dict(zip((cause.label for cause in Cause), deaths, strict=True)),
        "extinctions": counted("extinctions"),
        "crashes": crashed,
        "cell_ticks": tick * config.cells,
        "organism_ticks": counted("organism_ticks"),
        "mean_age": float(ages.mean()) if len(ages) else None,
        "oldest_age": int(ages.max()) if len(ages) else None,
        "tries_per_life": _tries(_climate(arrays, world), counted),
        "saturation": _moment(counted("saturated"), counted("saturated_births")),
        "fixation": _moment(counted("fixed"), counted("fixed_births")),
        "threshold": limit,
    }
    if config.act is not None:
        numbers["act"] = _act(counted)
    if (tally := arrays.get(TALLY)) is not None and alive.any():
        numbers["tallies"] = _tallies(run.description.tallies, tally[here][alive])
    if (traits := of_living(run, world)) is not None:
        numbers["traits"] = traits
    if config.metabolism is not None:
        numbers["break_even"] = _break_even(arrays, world, run.description.rate)
    if config.seasons:
        numbers["climate"] = _climate(arrays, world)
    return numbers


def _tries(climate: dict[str, float], counted: Callable[[str], int]) -> float | None:
    """Return the tries to replicate in a life of mean length; None if there were no births."""
    if not (births := counted("births")):
        return None
    if "replication" not in climate:
        return counted("acts.tries") / births
    return climate["replication"] * counted("organism_ticks") / births


def _act(counted: Callable[[str], int]) -> dict[str, float | None]:
    """Return the tries of a world, and the energy invested in children."""
    tries, births = counted("acts.tries"), counted("acts.births")
    invested = counted("acts.invested") / ONE
    return {
        "tries": tries,
        "failed": tries - births,
        "children": births,
        "invested": invested,
        "mean_endowment": invested / births if births else None,
    }


def _moment(tick: int, births: int) -> dict[str, int] | None:
    return None if tick == NEVER else {"tick": tick, "births": births}


def _tallies(names: tuple[str, ...], tally: np.ndarray) -> dict[str, dict[str, float]]:
    """Return median and maximum of each of the habitat's counts (n, tallies)."""
    return {
        name: {"median": float(np.median(column)), "best": int(column.max())}
        for name, column in zip(names, tally.T, strict=True)
    }


def _break_even(
    arrays: Mapping[str, np.ndarray], world: int, rate: float | None
) -> dict[str, float | None]:
    """Return the food that keeps energy constant; None if no amount does, or `rate` is unknown."""
    climate = _climate(arrays, world)
    tick = break_even(climate["metabolism.drain"], climate["metabolism.gain"])
    second = tick * rate if tick is not None and rate is not None else None
    return {"food_per_tick": tick, "food_per_second": second}


def _climate(arrays: Mapping[str, np.ndarray], world: int) -> dict[str, float]:
    return {
        name.removeprefix("world.worlds.climate."): arrays[name][world].tolist()
        for name in arrays
        if name.startswith("world.worlds.climate.")
    }
