"""Experiments as a whole: jobs against runs of the same worlds, and one core against all.

Each command is a process of its own, from its start to its end, with all its records on disk. Code was
compiled before and is kept on disk, as for a user's second experiment.
"""

import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import tomli_w

from primordia import cores

TICKS = 200_000
"""Ticks of each world, the limit of the shipped experiments."""
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
    middle = {name: sorted(values)[len(values) // 2] for name, values in rates.items()}
    return {
        "world_ticks_per_s": {name: [round(rate) for rate in each] for name, each in rates.items()},
        "jobs_of_runs": round(middle["jobs"] / middle["runs"], 3),
    }


def all_cores_against_one() -> dict[str, Any]:
    """Return how much faster an experiment is on all cores than on one."""
    count = cores.available()
    seconds: dict[int, list[float]] = {1: [], count: []}
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        file = _file(out, 1, 4 * count * EACH, EACH, 10 * TICKS)
        _seconds(lambda: _experiment(_file(out, 1, EACH, EACH, 10), out / "warm"))
        for round_number in range(ROUNDS):
            for jobs in seconds:
                place = out / f"{jobs}-{round_number}"
                spent = _seconds(lambda j=jobs, p=place: _experiment(file, p, "--jobs", str(j)))
                seconds[jobs].append(round(spent, 2))
    best = {jobs: sorted(each)[len(each) // 2] for jobs, each in seconds.items()}
    return {"seconds_by_jobs_at_a_time": seconds, "times": round(best[1] / best[count], 3)}


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
