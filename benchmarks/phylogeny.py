"""Seconds and peak memory of `primordia phylogeny`, by format, on a run of five million births.

The run is forged: a Moran process (Moran 1958) of 1,024 cells, in which at each birth the child of a
random organism takes the place of another one. It has all files of a run, and nothing in it has lived.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

BIRTHS, CELLS, EACH_TICK = 5_000_000, 1024, 6
WAYS = {
    "phylogeny.parquet": [],
    "phylogeny.csv": [],
    "phylogeny.nwk": [],
    "phylogeny.tsv": [],
    "extant.parquet": ["--extant"],
    "extant.nwk": ["--extant", "--collapse"],
    "line.csv": [str(BIRTHS - 1)],
}
"""The file that is written, and further words of the command."""


def forge(run: Path, births: int = BIRTHS, cells: int = CELLS) -> None:
    """Write a run of one world in which nothing was lived."""
    from primordia.config import Stop, load
    from primordia.engine.engine import Engine
    from primordia.runs import checkpoint, directory
    from primordia.runs.loop import recorder_for
    from primordia.runs.manifest import Progress

    config = load("CartPole-survival", {"cells": cells, "genesis": "fill"})
    engine, last = Engine(config), births // EACH_TICK + 1
    with directory.create(run, config):
        recorder = recorder_for(engine, run)
        born, died = moran(births, cells)
        recorder.add("births", recorder.schema.columns("births").rows(**born))
        recorder.add("deaths", recorder.schema.columns("deaths").rows(**died))
        recorder.finish()
        arrays = {name: np.array(each) for name, each in engine.arrays().items()}
        arrays["world.worlds.tick.lo"][:] = last
        arrays["world.worlds.births.lo"][:] = births
        checkpoint.save(run, arrays, recorder, Progress(limits=Stop(), wall_s=0.0, exact=True))


def moran(births: int, cells: int) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return the columns of births and of deaths of a Moran process, without `mate` and notes."""
    rng = np.random.default_rng(1)
    cell = np.concatenate([np.arange(cells), rng.integers(0, cells, births - cells)])
    source = (cell + rng.integers(1, cells, births)) % cells
    occupant, parent, dead = [-1] * cells, [-1] * births, [-1] * births
    for number, (here, there) in enumerate(zip(cell.tolist(), source.tolist(), strict=True)):
        if number >= cells:
            parent[number], dead[number] = occupant[there], occupant[here]
        occupant[here] = number
    tick = np.where(np.arange(births) < cells, 0, 1 + np.arange(births) // EACH_TICK)
    copies = np.where(np.arange(births) < cells, 0, rng.integers(1, 3, births))
    born = {"cell": cell, "id": np.arange(births), "parent": np.array(parent), "tick": tick}
    some = np.arange(cells, births)
    died = {"cell": cell[some], "id": np.array(dead)[some], "tick": tick[some]}
    zero = np.zeros_like(some)
    return born | {"cause": copies}, died | {"cause": zero + 3, "energy": zero, "food": zero}


def measured(run: Path, out: Path, words: list[str]) -> tuple[float, float, float]:
    """Return wall seconds, processor seconds and peak gigabytes of one command."""
    command = [sys.executable, "-m", "primordia", "phylogeny", str(run), *words, "--out", str(out)]
    began = time.perf_counter()
    child = os.posix_spawn(sys.executable, command, os.environ)
    _, status, usage = os.wait4(child, 0)
    assert status == 0, command
    wall = time.perf_counter() - began
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e9


def main() -> None:
    """Print a table, two rounds of each command."""
    with tempfile.TemporaryDirectory(dir=os.environ.get("SCRATCH")) as folder:
        run = Path(folder, "run")
        # In a process of its own: a child's peak memory counts that of the process that starts it.
        subprocess.run([sys.executable, __file__, str(run)], check=True)
        print("| file | options | seconds | processor seconds | peak GB | file MB |")
        print("|---|---|---|---|---|---|")
        for name, words in WAYS.items():
            out = Path(folder, name)
            rounds = [measured(run, out, words) for _ in range(2)]
            figures = (
                ", ".join(f"{each[0]:.1f}" for each in rounds),
                ", ".join(f"{each[1]:.1f}" for each in rounds),
                f"{max(each[2] for each in rounds):.2f}",
                f"{out.stat().st_size / 1e6:,.1f}",
            )
            print(f"| {name} | {' '.join(words)} | {' | '.join(figures)} |", flush=True)


if __name__ == "__main__":
    forge(Path(sys.argv[1])) if sys.argv[1:] else main()
