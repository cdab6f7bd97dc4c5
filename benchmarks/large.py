"""Seconds and peak memory of commands on a run of five million births.

    python benchmarks/large.py [BIRTHS]

The run is forged: a Moran process (Moran 1958) of 1,024 cells, in which at each birth the child of a
random organism takes the place of another one. It has all files of a run, and nothing in it has lived,
so a life that is lived again ends otherwise than recorded.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

BIRTHS, CELLS, EACH_TICK, ROUNDS = 5_000_000, 1024, 6, 2
COMMANDS = """
info RUN
ancestors RUN
lineages RUN
report RUN --out OUT/report.html
export RUN OUT/champion.safetensors
replay RUN --to 60 --out OUT/life.mp4
evaluate RUN --ticks 50 --games 2
phylogeny RUN --out OUT/phylogeny.parquet
phylogeny RUN --out OUT/phylogeny.csv
phylogeny RUN --out OUT/phylogeny.nwk
phylogeny RUN --out OUT/phylogeny.tsv
phylogeny RUN --extant --out OUT/extant.parquet
phylogeny RUN --extant --collapse --out OUT/extant.nwk
phylogeny RUN LAST --out OUT/line.csv
"""


def forge(run: Path, births: int) -> None:
    """Write a run of one world in which nothing was lived."""
    from primordia.config import Stop, load
    from primordia.engine.engine import Engine
    from primordia.runs import checkpoint, directory
    from primordia.runs.loop import recorder_for
    from primordia.runs.manifest import Progress

    config = load("CartPole-survival", {"cells": CELLS, "genesis": "fill"})
    engine, last = Engine(config), births // EACH_TICK + 1
    with directory.create(run, config):
        recorder = recorder_for(engine, run)
        born, died = moran(births)
        recorder.add("births", recorder.schema.columns("births").rows(**born))
        recorder.add("deaths", recorder.schema.columns("deaths").rows(**died))
        recorder.finish()
        arrays = {name: np.array(each) for name, each in engine.arrays().items()}
        arrays["world.worlds.tick.lo"][:] = last
        arrays["world.worlds.births.lo"][:] = births
        checkpoint.save(run, arrays, recorder, Progress(limits=Stop(), wall_s=0.0, exact=True))


def moran(births: int) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Return the columns of births and of deaths of a Moran process, without `mate` and notes."""
    rng = np.random.default_rng(1)
    cell = np.concatenate([np.arange(CELLS), rng.integers(0, CELLS, births - CELLS)])
    source = (cell + rng.integers(1, CELLS, births)) % CELLS
    occupant, parent, dead = [-1] * CELLS, [-1] * births, [-1] * births
    for number, (here, there) in enumerate(zip(cell.tolist(), source.tolist(), strict=True)):
        if number >= CELLS:
            parent[number], dead[number] = occupant[there], occupant[here]
        occupant[here] = number
    tick = np.where(np.arange(births) < CELLS, 0, 1 + np.arange(births) // EACH_TICK)
    copies = np.where(np.arange(births) < CELLS, 0, rng.integers(1, 3, births))
    born = {"cell": cell, "id": np.arange(births), "parent": np.array(parent), "tick": tick}
    some = np.arange(CELLS, births)
    died = {"cell": cell[some], "id": np.array(dead)[some], "tick": tick[some]}
    zero = np.zeros_like(some)
    return born | {"cause": copies}, died | {"cause": zero + 3, "energy": zero, "food": zero}


def measured(words: list[str]) -> tuple[float, float, float]:
    """Return wall seconds, processor seconds and peak gigabytes of one command.

    `replay` ends with status 1, since the life ends otherwise than recorded.
    """
    command = [sys.executable, "-m", "primordia", *words]
    began = time.perf_counter()
    quiet = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
    child = os.posix_spawn(sys.executable, command, os.environ, file_actions=quiet)
    _, status, usage = os.wait4(child, 0)
    assert os.waitstatus_to_exitcode(status) == (words[0] == "replay"), command
    wall = time.perf_counter() - began
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024 / 1e9


def main(births: int) -> None:
    """Print a table with all rounds of each command."""
    with tempfile.TemporaryDirectory(dir=os.environ.get("SCRATCH")) as folder:
        run, out = Path(folder, "run"), Path(folder, "out")
        out.mkdir()
        # In a process of its own: a child's peak memory counts that of the process that starts it.
        subprocess.run([sys.executable, __file__, str(births), str(run)], check=True)
        print("| command | seconds | processor seconds | peak GB |\n|---|---|---|---|")
        for line in COMMANDS.strip().splitlines():
            places = {"RUN": str(run), "LAST": str(births - 1)}
            words = [places.get(word, word.replace("OUT", str(out))) for word in line.split()]
            rounds = [measured(words) for _ in range(ROUNDS)]
            wall, spent = (", ".join(f"{each[k]:.1f}" for each in rounds) for k in (0, 1))
            peak = max(each[2] for each in rounds)
            print(f"| `{line}` | {wall} | {spent} | {peak:.2f} |", flush=True)


if __name__ == "__main__":
    births = int(sys.argv[1]) if sys.argv[1:] else BIRTHS
    forge(Path(sys.argv[2]), births) if sys.argv[2:] else main(births)
