"""Experiments as a whole: jobs against runs of the same worlds, and one core against all.

Each command is a process of its own, from its start to its end, with all its records on disk. Code was
compiled before and is kept on disk, as for a user's second experiment.
"""

import itertools
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import tomli_w

from primordia import cores

TICKS = 20_000
"""ticks of each world: a tenth of the shipped experiments' limit, so a start counts ten times as much"""
ARMS, WORLDS = 4, 100
EACH = 4
"""worlds of a job in the comparison of cores"""
ROUNDS = 3
COMMAND = [sys.executable, "-m", "primordia"]


def jobs_against_runs() -> dict[str, Any]:
    """Return the speed of 400 jobs of one world each, and of the same worlds in a run for each core."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        file = _file(out, ARMS, WORLDS, 1, TICKS)
        rates: dict[str, list[float]] = {"jobs": [], "runs": []}
        _seconds(lambda: _experiment(_file(out, 1, 2, 1, 10), out / "warm"))
        for round_number in range(ROUNDS):
            spent = _seconds(lambda n=round_number: _experiment(file, out / f"jobs{n}"))
            rates["jobs"].append(ARMS * WORLDS * TICKS / spent)
            spent = _seconds(lambda n=round_number: _runs(out, n))
            rates["runs"].append(ARMS * WORLDS * TICKS / spent)
    return {
        "world_ticks_per_s": {name: [round(rate) for rate in each] for name, each in rates.items()},
        "jobs_of_runs": round(median(rates["jobs"]) / median(rates["runs"]), 3),
    }


def all_cores_against_one() -> dict[str, Any]:
    """Return how much faster an experiment is on all cores than on one.

    The seconds in which the same jobs begin and end, with ten ticks each, are the start. They do not
    grow with an experiment, so `times` leaves them out; `times_with_start` does not.
    """
    count = cores.available()
    spent: dict[tuple[int, int], list[float]] = {
        (jobs, ticks): [] for ticks in (10, 10 * TICKS) for jobs in (1, count)
    }
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        _experiment(_file(out, 1, EACH, EACH, 10), out / "warm")
        for number, (jobs, ticks) in itertools.product(range(ROUNDS), spent):
            place = out / f"{jobs}-{ticks}-{number}"
            file = _file(out, 1, 4 * count * EACH, EACH, ticks)
            seconds = _seconds(lambda f=file, p=place, j=jobs: _experiment(f, p, "--jobs", str(j)))
            spent[jobs, ticks].append(round(seconds, 2))
    one_start, all_start, one, all_cores = map(median, spent.values())
    return {
        "seconds": {f"{jobs} at a time, {ticks} ticks": s for (jobs, ticks), s in spent.items()},
        "times": round((one - one_start) / (all_cores - all_start), 3),
        "times_with_start": round(one / all_cores, 3),
    }


def bookkeeping() -> dict[str, Any]:
    """Return the figures of `idle_jobs.py`, which is a process of its own since memory counts."""
    command = [sys.executable, str(Path(__file__).with_name("idle_jobs.py"))]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)


def _file(folder: Path, arms: int, worlds: int, each: int, ticks: int) -> Path:
    """Write an experiment whose arms differ in seeds only, so that they share compiled code."""
    file = folder / f"{arms}-{worlds}-{each}-{ticks}.toml"
    values = {
        "question": "How fast?",
        "task": "CartPole-survival",
        "seeds": worlds,
        "jobs": {"worlds": each},
        "stop": {"ticks": ticks, "until": "none"},
        "arms": [{"name": f"arm{arm}", "seed": arm * worlds} for arm in range(arms)],
    }
    file.write_text(tomli_w.dumps(values))
    return file


def _experiment(file: Path, out: Path, *more: str) -> None:
    """Run the jobs of all arms; the results are not part of it."""
    words = ["experiment", str(file), "--out", str(out), "--quiet", *more]
    subprocess.run([*COMMAND, *words], check=True, stdout=subprocess.DEVNULL)


def _runs(folder: Path, number: int) -> None:
    """Run the same worlds in a run for each core, side by side."""
    count = cores.available()
    worlds = ARMS * WORLDS // count
    limits = ["--ticks", str(TICKS), "--until", "none", "--quiet"]
    begun = []
    for core in range(count):
        own = ["--seed", str(core * worlds), "--seeds", str(worlds)]
        out = str(folder / f"run{number}-{core}")
        words = ["run", "CartPole-survival", *own, *limits, "--out", out]
        begun.append(subprocess.Popen([*COMMAND, *words]))
    for process in begun:
        assert process.wait() == 0


def _seconds(call: Callable[[], None]) -> float:
    began = time.perf_counter()
    call()
    return time.perf_counter() - began
