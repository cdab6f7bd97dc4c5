"""A program that lives runs on all devices that its process has, and prints what came out, as JSON.

    python -m tests.engine.sharing FOLDER

It begins the run FOLDER/run or goes on with it for TICKS ticks, verifies it, and forks it.
"""

import hashlib
import json
import sys
from pathlib import Path
from typing import Any

import jax
import numpy as np

import primordia
from primordia.engine import memory
from primordia.engine.engine import Engine
from primordia.random.wide import to_host
from primordia.runs import loop
from tests.worlds import MEADOW, MILL, Lived, config

TICKS = 150
CROWD: dict[str, Any] = {
    **MEADOW,
    "cells": 1000,
    "seeds": 4,
    "brain": {"kind": "feed-forward", "hidden": 1},
    "genesis": "fill",
    "replication": 0.9,
    "hazard": 0.4,
    "seasons": [{"kind": "schedule", "setting": "hazard", "at": 700, "value": 0.0}],
    "saturation_ticks": 40,
}
"""Worlds that fill the lists of events again and again, until nothing dies any more."""
HOST = {**MILL, "seeds": 4, "habitat": {"name": "tests.toys:Mirror", "inner": "mill"}}
RUN = {**MILL, "seeds": 6, "genesis": "fill"}
"""Every run of the mill has this law, so that a process compiles it once."""
LIVED: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "seasons": (RUN, {"ticks": 400}),
    "births": (RUN, {"ticks": 600, "births": 50}),
    "crowd": (CROWD, {"ticks": 3000, "until": "saturation"}),
}
"""name -> settings of a run, and how far it goes"""


def told(name: str) -> dict[str, Any]:
    """Live a run of LIVED, and tell where it stood after its second chunk, and what came of it."""
    settings, limits = LIVED[name]
    lived = Lived(config(settings), 1)
    lived.engine._ticks = 10**6
    lived.recorder.append(lived.engine.advance(lived.engine.limits(limits)))
    between = ticks(lived.engine)
    lived.advance_to(**limits)
    tables = {table: np.concatenate(rows) for table, rows in lived.rows.items()}
    return {
        "devices": devices(lived.engine),
        "between": between,
        "digests": lived.digests(),
        "ends": ticks(lived.engine),
        "births": to_host(lived.engine.state.world.worlds.births).tolist(),
        "tables": {name: hashlib.sha256(rows).hexdigest() for name, rows in tables.items()},
    }


def ticks(engine: Engine) -> list[int]:
    """Return the ticks that each world has lived through."""
    return to_host(engine.state.world.worlds.tick).tolist()


def devices(engine: Engine) -> int:
    """Return the number of devices that hold a state, after checking that their shares are equal."""
    counts = set()
    for leaf in jax.tree.leaves(engine.state.world):
        shares = {each.device: each.data.nbytes for each in leaf.addressable_shards}
        assert set(shares.values()) == {leaf.nbytes // len(shares)}
        counts.add(len(shares))
    (count,) = counts
    return count


def bytes_held() -> tuple[int, int]:
    """Return the bytes that a run is said to need, and those that it holds."""
    engine = Engine(config(LIVED["seasons"][0]))
    chunks: Any = engine.chunks
    lists = getattr(chunks, "_lists", chunks.events)
    held = sum(leaf.nbytes for leaf in jax.tree.leaves((engine.state, lists)))
    return memory.bytes_needed(engine.law, engine.config.build_habitat(), devices(engine)), held


def reloaded() -> bool:
    """Return whether a state that is stored and loaded lies where it lay, and leaves what was stored."""
    lived = Lived(config(LIVED["seasons"][0]), 100)
    arrays, before = lived.engine.arrays(), devices(lived.engine)
    stored = {name: array.copy() for name, array in arrays.items()}
    lived.engine.load(arrays)
    same = devices(lived.engine) == before
    lived.advance_to(200)
    return same and all(np.array_equal(arrays[name], stored[name]) for name in stored)


def one_part_of(run: Path) -> primordia.Run:
    """Begin a run, or go on with it, for TICKS ticks."""
    if not run.exists():
        loop.start(config(RUN, stop={"ticks": TICKS}), run)
        return primordia.load(run)
    begun = primordia.load(run)
    begun.resume(ticks=int(begun.only().ends.min()) + TICKS)
    return begun


def main(folder: Path) -> None:
    """Print all of the above."""
    run = one_part_of(folder / "run")
    fork = run.fork(TICKS // 2, folder / f"fork{jax.device_count()}", seed=9, stop={"ticks": TICKS})
    out = {
        "lived": {name: told(name) for name in LIVED},
        "host": devices(Engine(config(HOST))),
        "bytes": bytes_held(),
        "reloaded": reloaded(),
        "differences": run.verify(),
        "fork": [world["digest"] for world in fork.info()["worlds"]],
    }
    print(json.dumps(out))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
