"""Cost by number of cells, memory at a million cells, speed of records, and seconds from the shell."""

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

SIZES = [32, 256, 1024, 4096, 16_384, 65_536, 262_144, 1_048_576]


def cost_by_cells() -> list[dict]:
    """Measure each size in its own process, since peak memory is a property of a process."""
    rows = []
    for cells in SIZES:
        command = [sys.executable, __file__, str(cells)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        rows.append(json.loads(done.stdout))
    return rows


def _one_size(cells: int) -> dict:
    """Fill a world, live for some seconds, and return its speed and memory."""
    from worlds import engine, rate

    base = _peak_bytes(warm=True)
    made = engine(cells, genesis="fill")
    seconds = 1.0 if cells < 200_000 else 6.0
    lived = rate(made, seconds)
    arrays = made.arrays()
    held = ("world.organisms.genome", "world.organisms.memory", "bodies")
    state = sum(a.nbytes for name, a in arrays.items() if name.startswith(held))
    genome = sum(a.nbytes for name, a in arrays.items() if name.startswith(held[0]))
    moved = (genome + 2 * (state - genome)) / cells
    return {
        "cells": cells,
        "organism_ticks_per_s": lived,
        "ns_per_organism_tick": 1e9 / lived,
        "occupied": float(arrays["world.organisms.alive"].mean()),
        "bytes_per_cell_tick": moved,
        "gigabytes_per_s": moved * lived / float(arrays["world.organisms.alive"].mean()) / 1e9,
        "state_bytes": state,
        "peak_over_state": (_peak_bytes() - base) / state,
    }


def _peak_bytes(warm: bool = False) -> int:
    """Return peak resident memory in bytes; `warm` first compiles a small world, as a baseline."""
    if warm:
        from worlds import engine

        small = engine(32)
        small.advance(small.limits({}))
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def shell_to_saturation() -> list[float]:
    """Return the seconds from shell command to finished run, compilation included, for five seeds."""
    taken = []
    for seed in range(5):
        with tempfile.TemporaryDirectory() as folder:
            words = ["run", "CartPole-survival", "--seed", str(seed), "--out", f"{folder}/run"]
            began = time.perf_counter()
            subprocess.run(
                [sys.executable, "-m", "primordia", *words], capture_output=True, check=True
            )
            taken.append(time.perf_counter() - began)
    return taken


def births_recorded_per_second() -> float:
    """Return births per second, from rows as the law gives them to closed segments on disk."""
    import jax.numpy as jnp

    from primordia.law.events import BIRTHS, Events, Rows
    from primordia.runs.recorder import Recorder
    from primordia.runs.schema import Schema

    rng, rows, chunks = np.random.default_rng(0), 2**18, 24
    births = rng.integers(0, 1000, (rows, BIRTHS.width), dtype=np.uint32)
    births[:, -1] %= 3  # causes
    nothing = Rows(np.zeros((1, 1), np.uint32), jnp.int32(0))
    events = Events(Rows(births, jnp.int32(rows)), nothing, nothing)
    with tempfile.TemporaryDirectory() as folder:
        for name in ("births", "deaths", "metrics"):
            Path(folder, name).mkdir()
        recorder = Recorder(Path(folder), 32, Schema(32, (), (), ()))
        began = time.perf_counter()
        for _ in range(chunks):
            recorder.append(events)
        recorder.finish()
        return rows * chunks / (time.perf_counter() - began)


if __name__ == "__main__":
    print(json.dumps(_one_size(int(sys.argv[1]))))
