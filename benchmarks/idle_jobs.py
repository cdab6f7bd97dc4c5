"""What 10,000 jobs cost that do nothing: to begin and end them, to look at them, and to gather them.

    python benchmarks/idle_jobs.py

The runs that are gathered are copies of one small run, with other seeds.
"""

import json
import os
import resource
import shutil
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import tomli_w

from primordia import files
from primordia.config import Config
from primordia.experiments import job as jobs
from primordia.experiments.campaign import Campaign, begin, recorded
from primordia.experiments.dispatch import live_all
from primordia.experiments.ledger import Entry, Ledger, WorldCounts
from primordia.experiments.plan import Ending, Job
from primordia.runs import checkpoint, loop
from primordia.runs import manifest as manifests
from primordia.runs.manifest import Seal

ARMS, JOBS = 4, 10_000
SETTINGS = {"task": "CartPole-survival", "cells": 8, "stop": {"ticks": 200}}


def main() -> None:
    """Print the figures as JSON."""
    with tempfile.TemporaryDirectory() as folder:
        chosen = begin(_file(Path(folder)), Path(folder, "out"))
        place = _Nowhere(chosen)
        figures: dict[str, Any] = {"jobs": len(chosen.jobs)}
        figures["start_and_end_s"] = _seconds(
            lambda: live_all(chosen.left(), place, chosen.status, lambda *_: None)
        )
        figures["status_s"] = _seconds(lambda: _check_done(begin(chosen.path)))
        figures["peak_mb"] = _peak()
        maker = get_context("spawn").Process(target=_make_runs, args=(chosen.path,))
        maker.start()  # a process of its own: the memory of reading is measured in this one
        maker.join()
        figures["gather_s"] = _seconds(chosen.gather)
        figures["info_s"] = _seconds(chosen.info)
        figures["peak_with_gathering_mb"] = _peak()
    print(json.dumps(figures))


class _Nowhere:
    """A place where each job is done at once: what is left is bookkeeping."""

    def __init__(self, chosen: Campaign) -> None:
        self._ledger, self._path = Ledger(chosen.path, chosen.jobs), chosen.path

    def submit(self, job: Job) -> Future[Ending]:
        """Note that a job is done."""
        (self._path / job.folder).mkdir(parents=True)
        world = WorldCounts(
            seed=job.first, ticks=1, births=1, deaths=1, organism_ticks=1, saturated=None
        )
        done = Entry(job=job.number, arm=job.arm, state="done", worlds=[world])
        self._ledger.write(job, done)
        future: Future[Ending] = Future()
        future.set_result(Ending(job.number, "done"))
        return future

    def stop(self) -> None:
        """Do nothing."""


def _file(folder: Path) -> Path:
    file = folder / "idle.toml"
    arms = [{"name": f"arm{arm}", "replication": 0.1 + 0.1 * arm} for arm in range(ARMS)]
    shared = {"question": "Nothing?", "seeds": JOBS // ARMS, "jobs": {"worlds": 1}}
    file.write_text(tomli_w.dumps({**shared, **SETTINGS, "arms": arms}))
    return file


def _check_done(chosen: Campaign) -> None:
    assert chosen.status().jobs["done"] == JOBS


def _make_runs(path: Path) -> None:
    """Put the run of each job in its place: a copy of the first one of its arm, with its own seed."""
    chosen = recorded(path)
    originals: dict[str, Path] = {}
    for job in chosen.jobs:
        run, config = chosen.path / job.folder, jobs.configuration(chosen.plan, job)
        run.rmdir()
        if job.arm not in originals:
            loop.start(config, run)
            originals[job.arm] = run
        else:
            _copy(originals[job.arm], run, config)


def _copy(original: Path, run: Path, config: Config) -> None:
    shutil.copytree(original, run, copy_function=os.link)
    (run / "config.toml").unlink()
    (run / "config.toml").write_text(config.to_toml())
    for folder in checkpoint.numbered(run):
        file = folder / checkpoint.MANIFEST
        manifest = manifests.read(file)
        manifest.inputs["config.toml"] = Seal(**files.seal(run / "config.toml"))
        file.unlink()
        file.write_text(manifest.text())


def _seconds(call: Callable[[], object]) -> float:
    began = time.perf_counter()
    call()
    return round(time.perf_counter() - began, 2)


def _peak() -> int:
    """Return the largest memory of this process so far, in MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


if __name__ == "__main__":
    main()
