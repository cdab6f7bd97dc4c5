"""Organisms drawn from finished runs are lived again: does each life agree with its record?

`python benchmarks/relived.py FOLDER [SHARE]` makes the runs in FOLDER (those that are there already are
taken), relives a share of the number of organisms of each, and prints a table.
"""

import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import primordia
from primordia import device
from primordia.api import Run
from primordia.errors import InputError
from primordia.organism.organism import Organism
from primordia.organism.reliving.compare import Reliving
from primordia.random.keys import Purpose, bits, stream
from primordia.random.wide import to_host, wide

SEED = 20261124
"""of the draws"""
EVERY = 2.0
"""seconds between checkpoints, of which a run keeps two"""
ACCIDENTS = {"seeds": 2, "cells": 64, "hazard": 0.0005}
MUTATED: dict[str, Any] = {"probability": 0.5, "founder_scale": 0.01}
CARTPOLES: dict[str, dict[str, Any]] = {
    "Gaussian mutation": {},
    "heritable scale": {"mutation": {"kind": "heritable", **MUTATED}},
    "heritable scale of cells": {"mutation": {"kind": "heritable", "belongs": "cell", **MUTATED}},
    "calibrated mutation": {"mutation": {"kind": "calibrated", **MUTATED}},
    "two parents, rows": {"recombination": {"unit": "row"}, "mutation": MUTATED},
    "two parents, blocks": {
        "recombination": {"unit": "block"},
        "mutation": {"kind": "calibrated", **MUTATED},
    },
    "no heredity": {"inheritance": "founder"},
    "children replace neighbours": {"placement": {"topology": "torus8", "rule": "replacing"}},
}
"""Settings of CartPole-survival: each operator of heredity, and each way to die."""
HOSTED: dict[str, tuple[str, dict[str, Any], int]] = {
    "two worlds": ("Pong-survival", {"seeds": 2}, 800),
    "random starts, sticky, calibrated, two parents": (
        "Pong-survival-forager",
        {
            "hazard": 0.0005,
            "habitat": {"sticky": 0.25, "noops": 30},
            "mutation": {"kind": "calibrated", "probability": 0.5, "founder_scale": 0.3},
            "recombination": {},
        },
        1200,
    ),
    "hunger": ("HalfCheetah-forager", {"cells": 64}, 1200),
    "a season that hardens": ("HalfCheetah-forager-ratchet", {"cells": 64}, 800),
    "no hunger": ("BattleZone-survival", {"seeds": 2, "hazard": 0.0005}, 1500),
    "hunt or starve": ("BattleZone-survival-forager", {"seeds": 2}, 1500),
}
"""What is special: the task, settings, and ticks."""
CARTPOLE = "CartPole-survival"
RUNS = {name: (CARTPOLE, ACCIDENTS | own, 20_000) for name, own in CARTPOLES.items()} | HOSTED
FORKED = "Gaussian mutation", "random starts, sticky, calibrated, two parents"
"""Runs that are forked, and their forks too."""
NUMBERS = {"CartPole": 60, "Pong": 60, "HalfCheetah": 75, "BattleZone": 75, "fork": 50}
"""organisms of each run of a game, and of each fork of a fork; 1,000 in all"""


def main() -> None:
    """Make the runs, relive organisms of each, and print a table."""
    device.prepare()
    folder, share = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 1.0
    print("| task | special | organisms | relived | agree | from a checkpoint too | agree "
          "| ticks lived | seconds |", "|---" * 9 + "|", sep="\n", flush=True)  # fmt: skip
    rows = []
    for number, (task, special, run, count) in enumerate(runs(folder)):
        row = relived(run, max(1, round(share * count)), number)
        rows.append(row)
        print(f"| {task} | {special} | {' | '.join(f'{each:,}' for each in row)} |", flush=True)
    whole = " | ".join(f"{sum(column):,}" for column in zip(*rows, strict=True))
    print(f"| all | | {whole} |")


def runs(folder: Path) -> Iterator[tuple[str, str, Run, int]]:
    """Make each run when it is asked for -> task, what is special, the run, number of organisms."""
    for number, (special, (task, settings, ticks)) in enumerate(RUNS.items()):
        run = Run(folder / f"{number}")
        if not run.path.exists():
            limits = {"until": "none", "ticks": ticks}
            own = {**settings, "stop": limits}
            primordia.run(task, run.path, own, checkpoint_every=EVERY)
        yield task, special, run, NUMBERS[task.partition("-")[0]]
        if special in FORKED:
            yield task, f"a fork of a fork of {special}", forked(run, ticks), NUMBERS["fork"]


def forked(run: Run, ticks: int) -> Run:
    """Return a fork of a fork, each with another seed and half as long as the run."""
    for number in (1, 2):
        at, out = ticks * number // 2 + ticks // 4, Path(f"{run.path}-fork{number}")
        stop = {"until": "none", "ticks": at + ticks // 2}
        settings = {"seed": 100 * number, "stop": stop}
        run = Run(out) if out.exists() else run.fork(at, out, settings, checkpoint_every=EVERY)
    return run


def relived(run: Run, count: int, number: int) -> tuple[int, ...]:
    """Live organisms again of a run -> the numbers of a row of the table."""
    began, records = time.perf_counter(), run.opened()
    lives = np.arange(len(records.lives), dtype=np.uint32)
    words = to_host(bits(stream(wide(SEED), Purpose.EVALUATION, wide(number)), lives))
    drawn = np.argsort(words, kind="stable")[:count].tolist()
    agreed = later = agreed_later = ticks = 0
    for organism in (Organism(records, row) for row in drawn):
        found = organism.relive()
        agreed, ticks = agreed + agrees(run, found), ticks + found.ends - found.begins
        try:  # most died before the first of the checkpoints that are kept
            found = organism.relive(since=found.ends - 1)
        except InputError:
            continue
        later, agreed_later = later + 1, agreed_later + agrees(run, found)
    seconds = round(time.perf_counter() - began)
    return len(records.lives), len(drawn), agreed, later, agreed_later, ticks, seconds


def agrees(run: Run, found: Reliving) -> bool:
    """Return whether a life agrees with its record; report it if not."""
    if not found.agrees:
        print(f"{run.path}: {found.to_dict()}", file=sys.stderr, flush=True)
    return found.agrees


if __name__ == "__main__":
    main()
