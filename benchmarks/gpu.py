"""What a GPU gives: whether the promises hold on it, and the speed of worlds there (`make gpu`).

    python benchmarks/gpu.py [--minutes 9] [--device cpu] [--cells 32,1024] [--json FILE]

If JAX finds no GPU, a line says so, and nothing is measured. Each result is printed as soon as it is
known, and each row is then in the file. What has not begun when the time is nearly up is left out, and
named. The exit status is 1 if a promise does not hold.

- promises: the trials of `primordia doctor`.
- poles: organism-ticks per second of full worlds of CartPole whose organisms balance their poles. `limit`
  is the same brains and bodies without law, `calm` a world without deaths, and `births` one with an
  accident in HAZARD of all organism-ticks, and as many births.
- environments: body-ticks per second of worlds in environments in JAX, beside the loop of
  `functional.py` without brains and law.
"""

import argparse
import datetime
import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import jax

from functional import bare, stepped
from primordia import config, device
from primordia.engine.engine import Engine
from primordia.errors import InputError
from speed import limit_rate
from worlds import rate, saturated_phase

POLES = [(1, 32), (1, 1024), (1, 32_768), (1, 1_048_576), (1024, 32)]
"""worlds, and cells of each"""
ENVIRONMENT_CELLS = [1024, 4096, 65_536]
ENVIRONMENTS = {
    "Breakout-MinAtar": "MinAtar-Breakout-survival",
    "SpaceInvaders-MinAtar": "MinAtar-SpaceInvaders-survival",
    "Craftax-Classic-Symbolic-v1": "Craftax-Classic-survival",
    "playground:CartpoleBalance": "CartPole-survival",
}
"""Environments, and the task whose law our worlds have."""
HAZARD, SECONDS, LEFT = 0.001, 1.0, 90.0
"""`LEFT`: seconds that the last measurement may take, with its compilation."""


def main() -> None:
    """Try the promises, measure all sizes until the time is up, and write the figures to a file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default="gpu", help="gpu or cpu")
    parser.add_argument("--minutes", type=float, default=9.0, help="time for all measurements")
    parser.add_argument("--cells", default="", help="sizes of worlds, with commas between")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    ends = time.monotonic() + 60 * chosen.minutes - LEFT
    promises = list(_promises(chosen.device))
    if not promises:
        return
    sizes = [int(word) for word in chosen.cells.split(",") if word]
    rows: list[dict[str, Any]] = []
    with device.selected(chosen.device):
        about = {"date": datetime.date.today().isoformat(), **device.versions()}
        for what, measured in _measurements(sizes):
            in_time = time.monotonic() < ends
            rows.append({"what": what, **(_tried(measured) if in_time else {"error": "no time"})})
            print(json.dumps(rows[-1]), flush=True)
            jax.clear_caches()
            if chosen.json:
                found = {**about, "promises": promises, "rows": rows}
                chosen.json.write_text(json.dumps(found, indent=1) + "\n")
    sys.exit(any(line.startswith("FAILS") for line in promises))


def _promises(name: str) -> Iterator[str]:
    """Yield a line for each promise, and print all that the doctor says; nothing if it says nothing.

    They are tried in a process of its own, since a process keeps most of a GPU's memory to itself.
    """
    command = [sys.executable, "-u", "-m", "primordia", "doctor", "--device", name]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as doctor:
        assert doctor.stdout is not None
        for line in doctor.stdout:
            print(line, end="", flush=True)
            if line.startswith(("holds", "FAILS")):
                yield line.strip()


def _measurements(sizes: list[int]) -> Iterator[tuple[str, Callable[[], dict[str, float]]]]:
    """Yield the name and the function of each measurement, the most wanted first."""
    for worlds, cells in [(1, size) for size in sizes] or POLES:
        yield f"poles {worlds:,} x {cells:,}", partial(_poles, worlds, cells)
    for cells in sizes or ENVIRONMENT_CELLS:
        for env, task in ENVIRONMENTS.items():
            yield f"{env} {cells:,}", partial(_environment, env, task, cells)


def _poles(worlds: int, cells: int) -> dict[str, float]:
    calm = saturated_phase(cells, worlds, settled=1)
    limit_rate(calm)
    rates = {"limit": limit_rate(calm), "calm": rate(calm, SECONDS)}
    dying = saturated_phase(cells, worlds, settled=1, hazard=HAZARD)
    rate(dying, SECONDS)
    rates["births"] = rate(dying, SECONDS)
    return {
        **{name: round(each) for name, each in rates.items()},
        "calm / limit": round(rates["calm"] / rates["limit"], 3),
        "births / calm": round(rates["births"] / rates["calm"], 3),
    }


def _environment(env: str, task: str, cells: int) -> dict[str, float]:
    habitat = {"name": "gymnax", "env": env}
    made = Engine(config.load(task, {"cells": cells, "genesis": "fill", "habitat": habitat}))
    ours, loop = stepped(made), bare(env, cells)()
    return {"ours": round(ours), "bare": round(loop), "ours / bare": round(ours / loop, 3)}


def _tried(measured: Callable[[], dict[str, float]]) -> dict[str, Any]:
    """Return the figures, and the seconds with compilation, or the reason why there are none."""
    began = time.monotonic()
    try:
        found: dict[str, Any] = measured()
    except (InputError, ValueError, jax.errors.JaxRuntimeError) as error:
        return {"error": str(error).splitlines()[0]}
    return {**found, "seconds": round(time.monotonic() - began, 1)}


if __name__ == "__main__":
    main()
