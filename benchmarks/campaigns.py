"""Experiments as a whole: jobs against runs of the same worlds, one core against all, and bookkeeping.

Each command is a process of its own, from its start to its end, with all its records on disk. Code was
compiled before and is kept on disk, as for a user's second experiment.
"""

import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import tomli_w

from primordia import cores
from primordia.experiments.campaign import live_all
from primordia.experiments.experiment import Experiment, begin
from primordia.experiments.ledger import Entry, Ledger, World
from primordia.experiments.outcome import Outcome
from primordia.experiments.plan import Job

TICKS = 200_000
"""Ticks of each world, the limit of the shipped experiments."""
ARMS, WORLDS = 4, 100
EACH = 4
"""worlds of a job in the comparison of cores"""
IDLE = 10_000
"""jobs that do nothing"""
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
    """Return the seconds and the memory that 10,000 jobs take which do nothing."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        began = time.perf_counter()
        chosen = begin(_file(out, ARMS, IDLE // ARMS, 1, TICKS), out / "idle")
        live_all(chosen.left(), _Nowhere(chosen), chosen.status, lambda *_: None)
        started = time.perf_counter()
        told = begin(chosen.path).status()
        seen = time.perf_counter()
        assert told.jobs["done"] == len(chosen.jobs)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {
        "jobs": len(chosen.jobs),
        "start_and_end_s": round(started - began, 1),
        "status_s": round(seen - started, 2),
        "peak_mb": round(peak),
    }


class _Nowhere:
    """A place where each job is done at once: what is left is bookkeeping."""

    def __init__(self, chosen: Experiment) -> None:
        self._ledger = Ledger(chosen.path, chosen.jobs)
        self._path = chosen.path

    def submit(self, job: Job) -> Future[Outcome]:
        """Note that a job is done."""
        (self._path / job.folder).mkdir(parents=True)
        world = World(
            seed=job.first, ticks=1, births=1, deaths=1, organism_ticks=1, saturated=None
        )
        done = Entry(job=job.number, arm=job.arm, state="done", worlds=[world])
        self._ledger.write(job, done)
        future: Future[Outcome] = Future()
        future.set_result(Outcome(job.number, "done"))
        return future

    def stop(self) -> None:
        """Do nothing."""


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
