"""What a run directory tells: read only, without running anything."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from primordia.config import Config
from primordia.errors import InputError
from primordia.habitats.contract import AnyHabitat
from primordia.law.metabolism import break_even
from primordia.law.world import Cause
from primordia.runs import checkpoint
from primordia.runs.checkpoint import Checkpoint
from primordia.runs.digest import digests
from primordia.runs.directory import read_config
from primordia.runs.record import TABLES, Recorder

NEVER = 2**64 - 1
TALLY = "bodies.tally"


def info(run: Path) -> dict[str, Any]:
    """A run in one object.

    `saturation` and `fixation` are None, or the tick and the births (founders counted) at which they
    came. Ages are those of the living, in ticks; so is what the habitat counts (`tallies`).
    `break_even` is the food, a tick and a second, that keeps energy where it is, and `tries_per_life`
    how often an organism tries to copy itself in a life of mean length, as the world stands now. Below
    one a lineage cannot last. With one world its fields also stand at the top.
    """
    config, last = opened(run)
    arrays = last.arrays()
    each = digests(last.digests, arrays, config.seeds)
    habitat = config.build_habitat()
    worlds = [_world(config, habitat, arrays, world, digest) for world, digest in enumerate(each)]
    recorded = json.loads((run / "versions.json").read_text())
    whole = {
        "task": config.task,
        "inheritance": config.inheritance,
        "cells": config.cells,
        "seeds": config.seeds,
        "worlds": worlds,
        "wall_s": last.progress.wall_s,
        "exact": last.progress.exact,
        "limits": last.progress.limits,
        "versions": recorded,
    }
    return whole if config.seeds > 1 else {**worlds[0], **whole}


def opened(run: Path) -> tuple[Config, Checkpoint]:
    """Configuration and newest good checkpoint.

    Raises:
        InputError: this is no run, or it has no checkpoint yet.
        Trouble: none of its checkpoints is whole.
    """
    config = read_config(run)
    last, faults = checkpoint.newest(run)
    if last is None and faults:
        raise checkpoint.none_whole(run, faults)
    if last is None:
        raise InputError(f"{run} has no checkpoint yet; `primordia resume {run}` goes on with it")
    return config, last


def table(run: Path, name: str) -> pa.Table:
    """`births`, `deaths` or `metrics`: closed segments and open tail, in the order of events."""
    config, last = opened(run)
    return _table(run, name, config, last)


def _table(run: Path, name: str, config: Config, last: Checkpoint) -> pa.Table:
    assert name in TABLES
    parts = [pq.read_table(run / name / each["name"]) for each in last.manifest["segments"][name]]
    habitat = config.build_habitat()
    blocks = list(config.build_brain(habitat).blocks)
    recorder = Recorder(None, config.seeds, config.cells, blocks, habitat.tallies)
    parts.append(recorder.arrow(name, last.arrays()[f"tail.{name}"]))
    return pa.concat_tables(parts)


def world_ticks(arrays: dict[str, np.ndarray]) -> np.ndarray:
    """Ticks each world has lived through, uint64 (W,), from a checkpoint's arrays."""
    return counts(arrays, "world.worlds.tick")


def counts(arrays: dict[str, np.ndarray], name: str) -> np.ndarray:
    """Numbers of 64 bits, uint64, from a checkpoint's arrays, where they stand in two words."""
    hi, lo = arrays[f"{name}.hi"].astype(np.uint64), arrays[f"{name}.lo"]
    return (hi << np.uint64(32)) | lo


def _world(
    config: Config, habitat: AnyHabitat, arrays: dict[str, np.ndarray], world: int, digest: str
) -> dict[str, Any]:
    def count(name: str) -> Any:
        return counts(arrays, f"world.worlds.{name}")[world].tolist()

    here = slice(world * config.cells, (world + 1) * config.cells)
    alive = arrays["world.organisms.alive"][here]
    tick = count("tick")
    ages = tick - counts(arrays, "world.organisms.born")[here][alive].astype(np.int64)
    deaths = count("deaths")
    found = {
        "seed": config.seed + world,
        "ticks": tick,
        "alive": int(alive.sum()),
        "births": count("births"),
        "deaths": sum(deaths),
        "deaths_by_cause": dict(zip((cause.label for cause in Cause), deaths, strict=True)),
        "extinctions": count("extinctions"),
        "cell_ticks": tick * config.cells,
        "organism_ticks": count("organism_ticks"),
        "mean_age": float(ages.mean()) if len(ages) else None,
        "oldest_age": int(ages.max()) if len(ages) else None,
        "tries_per_life": _tries(_climate(arrays, world)["replication"], count),
        "saturation": _moment(count("saturated"), count("saturated_births")),
        "fixation": _moment(count("fixed"), count("fixed_births")),
        "digest": digest,
    }
    if (tally := arrays.get(TALLY)) is not None and alive.any():
        found["tallies"] = _of_the_living(habitat.tallies, tally[here][alive])
    if config.metabolism is not None:
        found["break_even"] = _break_even(arrays, world, habitat.rate)
    if config.seasons:
        found["climate"] = _climate(arrays, world)
    return found


def _tries(replication: float, count: Callable[[str], int]) -> float | None:
    births = count("births")
    return replication * count("organism_ticks") / births if births else None


def _moment(tick: int, births: int) -> dict[str, int] | None:
    return None if tick == NEVER else {"tick": tick, "births": births}


def _of_the_living(names: tuple[str, ...], tally: np.ndarray) -> dict[str, dict[str, float]]:
    """Median and best of what the habitat counts."""
    return {
        name: {"median": float(np.median(column)), "best": int(column.max())}
        for name, column in zip(names, tally.T, strict=True)
    }


def _break_even(
    arrays: dict[str, np.ndarray], world: int, rate: float | None
) -> dict[str, float | None]:
    """Food that keeps energy where it is; None where none does, or without seconds."""
    climate = _climate(arrays, world)
    each = break_even(climate["metabolism.drain"], climate["metabolism.gain"])
    second = each * rate if each is not None and rate is not None else None
    return {"food_per_tick": each, "food_per_second": second}


def _climate(arrays: dict[str, np.ndarray], world: int) -> dict[str, float]:
    return {
        name.removeprefix("world.worlds.climate."): array[world].tolist()
        for name, array in arrays.items()
        if name.startswith("world.worlds.climate.")
    }
