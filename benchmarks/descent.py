"""Seconds and memory of `ancestors`, `lines` and `report` on millions of births, with invented records.

    python benchmarks/descent.py [BIRTHS] [CELLS]

The pedigree is a Moran process: each tick has one birth and one death, of random organisms.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from primordia.law.events import BIRTHS, DEATHS
from primordia.law.world import BirthCause, Cause
from primordia.runs import checkpoint
from primordia.runs.archive import Archive
from primordia.runs.recorder import Recorder

NONE = -1


def pedigree(births: int, cells: int) -> tuple[np.ndarray, ...]:
    """Return parents (L,), and who dies at each tick from 1 on (births,)."""
    rng = np.random.default_rng(0)
    parents, dying = rng.integers(0, cells, (2, births)).tolist()
    place, parent, dead = list(range(cells)), [NONE] * cells, []
    for tick in range(births):
        parent.append(place[parents[tick]])
        dead.append(place[dying[tick]])
        place[dying[tick]] = cells + tick
    return np.array(parent), np.array(dead)


def forge(run: Path, births: int, cells: int) -> None:
    """Begin a run of CartPole-survival, and replace its records by invented ones."""
    words = ["run", "CartPole-survival", "--cells", str(cells), "--genesis", "fill", "--ticks", "3"]
    subprocess.run(
        [sys.executable, "-m", "primordia", *words, "--out", str(run), "--quiet"], check=True
    )
    begun = Archive(run)
    arrays, schema, progress = dict(begun.state), begun.schema, begun.progress
    arrays = {name: array for name, array in arrays.items() if not name.startswith("tail.")}
    for folder in ("births", "deaths", "metrics"):
        for old in (run / folder).iterdir():
            old.unlink()
    arrays["world.worlds.tick.lo"] = np.array([births], np.uint32)
    parent, dead = pedigree(births, cells)
    number = np.arange(len(parent))
    cause = np.where(parent == NONE, BirthCause.FOUNDER, BirthCause.MUTANT)
    born = np.maximum(number - cells + 1, 0)
    recorder = Recorder(run, 1, schema)
    cell = number % cells
    recorder.add("births", BIRTHS.rows(cell=cell, id=number, parent=parent, tick=born, cause=cause))
    zero = np.zeros(births, np.int64)
    deaths = {"cell": dead % cells, "id": dead, "tick": zero + 1 + np.arange(births)}
    deaths |= {"cause": zero + Cause.FATAL, "energy": zero, "food": zero}
    recorder.add("deaths", DEATHS.rows(**deaths))
    checkpoint.save(run, arrays, recorder, progress)


def measure(run: Path, command: str) -> None:
    """Call a command twice, each in a process of its own, and print seconds and memory."""
    for _ in range(2):
        began = time.perf_counter()
        subprocess.run(
            [sys.executable, "-m", "primordia", command, str(run)],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        print(
            f"{command}: {time.perf_counter() - began:.2f} s, {used.ru_maxrss / 1e6:.2f} GB so far"
        )


if __name__ == "__main__":
    births, cells = (
        int(word) for word in (*sys.argv[1:], *("5000000", "1024")[len(sys.argv) - 1 :])
    )
    with tempfile.TemporaryDirectory() as folder:
        forge(Path(folder, "run"), births, cells)
        for command in ("info", "ancestors", "lineages", "report"):
            measure(Path(folder, "run"), command)
