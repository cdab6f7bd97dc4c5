"""Jobs: wherever, in whatever order and however often cut off they are lived, each world is the same."""

import csv
import errno
import json
import os
import random
import shutil
import signal
import subprocess
import sys
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.experiments import here as on_cores
from primordia.experiments import job as jobs
from primordia.experiments.campaign import Campaign, begin
from primordia.experiments.dispatch import live_all
from primordia.experiments.plan import Ending, Job
from primordia.runs import directory, loop
from tests import commands, toys
from tests.commands import complains, here
from tests.experiments.meadows import write


def digests_of(experiment: Campaign) -> dict[str, list[str]]:
    """Return the digests of the worlds of each arm."""
    told = primordia.load(experiment.path).info()
    assert told["jobs"] == {"done": len(experiment.jobs), "running": 0, "failed": 0, "waiting": 0}
    return {arm["name"]: [world["digest"] for world in arm["worlds"]] for arm in told["arms"]}


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """Return the digests of each arm's worlds, each lived alone. Jobs have two worlds, or one."""
    folder = tmp_path_factory.mktemp("alone")
    found: dict[str, list[str]] = {}
    for arm in begin(write(folder), folder / "out").plan.arms:
        for world in range(arm.config.seeds):
            own = {"seed": arm.config.seed + world, "seeds": 1}
            run = folder / f"{arm.name}-{world}"
            loop.start(arm.config.model_copy(update=own), run)
            (told,) = primordia.load(run).info()["worlds"]
            found.setdefault(arm.name, []).append(told["digest"])
    return found


@pytest.mark.slow
def test_jobs_in_any_order_make_the_worlds_of_one_run(
    tmp_path: Path, alone: dict[str, list[str]]
) -> None:
    """By `--job K`, as the entries of a job array do."""
    file, out = write(tmp_path), tmp_path / "out"
    order = list(range(4))
    random.Random(5).shuffle(order)
    for number in [*order, order[0]]:
        done = here("experiment", file, "--out", out, "--job", number, "--quiet")
        assert done.returncode == 0, done.stderr
    assert digests_of(begin(out)) == alone


def test_what_a_kill_leaves_is_taken_up(tmp_path: Path, alone: dict[str, list[str]]) -> None:
    """A folder in which a run was about to begin, and a run in the middle of its life.

    The processes of the next test find the code of these jobs.
    """
    chosen = begin(write(tmp_path), tmp_path / "out")
    half = chosen.path / chosen.jobs[0].folder
    (half / "births").mkdir(parents=True)
    (half / "config.toml").write_text("begun")
    (half / directory.UNBEGUN).touch()
    config = jobs.configuration(chosen.plan, chosen.jobs[1])
    part = config.model_copy(update={"stop": config.stop.model_copy(update={"ticks": 77})})
    loop.start(part, chosen.path / chosen.jobs[1].folder)
    for job in chosen.jobs:
        assert jobs.ending_of(chosen.plan, job, chosen.path) == Ending(job.number, "done")
    assert digests_of(begin(chosen.path)) == alone


def test_an_experiment_is_run_once_on_all_cores_though_processes_die(
    tmp_path: Path, alone: dict[str, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each of the first two processes is killed as soon as it is there, before it compiles anything."""
    started, begun = on_cores.Here._started, []

    def dying(self: on_cores.Here) -> object:
        worker = started(self)
        begun.append(worker)
        if len(begun) <= 2:
            os.kill(worker.pid, signal.SIGKILL)
        return worker

    monkeypatch.setattr(on_cores.Here, "_started", dying)
    file, out = write(tmp_path), tmp_path / "out"
    done = here("experiment", file, "--out", out, "--jobs", 2)
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("the job's process ended with status -9") == 2
    assert done.stderr.count("the job is tried again") == 2
    assert len(begun) == 4
    assert done.stdout.splitlines()[-3:] == [f"{out}/results.{end}" for end in ("md", "csv", "png")]
    assert digests_of(begin(out)) == alone
    rows = list(csv.DictReader((out / "results.csv").read_text().splitlines()))
    assert [(row["arm"], row["seed"]) for row in rows] == [
        (arm, str(seed)) for arm in ("mild", "harsh") for seed in range(3, 6)
    ]
    assert (out / "results.md").read_text().startswith("# Is it mild?")
    before = {
        path: path.stat().st_mtime_ns for path in out.rglob("*") if "results" not in path.name
    }
    results = (out / "results.md").read_bytes()
    assert here("experiment", file, "--out", out).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert (out / "results.md").read_bytes() == results


@pytest.mark.slow
def test_a_fork_goes_on_from_the_worlds_of_an_arm(tmp_path: Path) -> None:
    """Unchanged, it lives on as the arm would have."""
    folder, runs = tmp_path / "files", tmp_path / "runs"
    one = begin(write(folder, "one"), runs / "one")
    for job in one.jobs:
        jobs.live(one.plan, job, one.path)
    names = ("task", "seed", "seeds", "replication", "saturation_ticks", "hazard", "brain", "jobs")
    arms = [{"name": "same"}, {"name": "other", "seed": 40}, {"name": "safe", "hazard": 0.0}]
    fork = {"of": "one/harsh", "at": 150}
    file = write(folder, "two", fork=fork, arms=arms, **dict.fromkeys(names))
    two = begin(file, runs / "two")
    for job in two.jobs:
        jobs.live(two.plan, job, two.path)
    once, same, other, safe = (
        primordia.load(place)
        .table("deaths")
        .sort_by([("world", "ascending"), ("tick", "ascending")])
        for place in (runs / "one" / "harsh", *(runs / "two" / arm["name"] for arm in arms))
    )
    later = [row for row in once.to_pylist() if row["tick"] > 150]
    assert later
    assert sorted(map(str, same.to_pylist())) == sorted(map(str, later))
    assert "hazard" in same["cause"].to_pylist()
    assert "hazard" not in safe["cause"].to_pylist()
    assert len(other)
    assert other.to_pylist() != same.to_pylist()
    seeds = [world["seed"] for world in primordia.load(runs / "two" / "other").info()["worlds"]]
    assert seeds == [40, 41, 42]
    place = {"of": str(runs / "one" / "harsh"), "at": 150}
    by_place = begin(
        write(folder, "three", fork=place, arms=arms, **dict.fromkeys(names)), runs / "3"
    )
    assert by_place.plan.arms == two.plan.arms
    assert [job.worlds for job in by_place.jobs] == [job.worlds for job in two.jobs]


@pytest.mark.slow
def test_a_job_that_fails_stops_no_other_job(tmp_path: Path) -> None:
    file, out = write(tmp_path), tmp_path / "out"
    chosen = begin(file, out)
    (out / "mild").mkdir()
    (out / chosen.jobs[2].folder).write_text("in the way")
    done = here("experiment", file, "--out", out, "--jobs", 1)
    assert done.returncode == 1
    lines = done.stderr.strip().splitlines()
    assert lines[0].startswith("primordia: job 2 (mild) failed: ")
    assert "tried again" not in lines[0]  # it would end in the same way
    assert len(lines) == 2
    assert lines[-1].endswith("1 job failed; give the same command to try again")
    told = json.loads(here("experiment", out, "--status", "--json").stdout)
    assert told["jobs"] == {"done": 3, "running": 0, "failed": 1, "waiting": 0}
    assert [entry["job"] for entry in told["failed"]] == [2]
    complains(here("experiment", out, "--job", 2), 1, "job 2 (mild) failed")
    (out / chosen.jobs[2].folder).unlink()
    assert here("experiment", file, "--out", out).returncode == 0


@pytest.mark.slow
def test_a_job_whose_disk_is_full_fails_alone_and_is_lived_later(
    tmp_path: Path, alone: dict[str, list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    chosen = begin(write(tmp_path), tmp_path / "out")
    for job in chosen.jobs:
        with monkeypatch.context() as patch:
            if job.number == 2:
                patch.setattr(np, "savez", full)
            ending = jobs.ending_of(chosen.plan, job, chosen.path)
        assert ending.state == ("failed" if job.number == 2 else "done")
        assert ("No space left on device" in (ending.error or "")) == (job.number == 2)
    assert here("experiment", chosen.path).returncode == 0
    assert digests_of(chosen) == alone


def test_the_status_tells_what_is_done_without_opening_a_run(tmp_path: Path) -> None:
    chosen = begin(write(tmp_path), tmp_path / "out")
    for job in chosen.jobs[:3]:
        jobs.live(chosen.plan, job, chosen.path)
    arms = {arm["name"]: arm["worlds"] for arm in primordia.load(chosen.path).info()["arms"]}
    for path in chosen.path.glob("*/*/checkpoints"):
        shutil.rmtree(path)
    told = begin(chosen.path).status()
    assert told.jobs == {"done": 3, "running": 0, "failed": 0, "waiting": 1}
    assert [(arm.begun, arm.worlds) for arm in told.arms] == [(3, 3), (2, 3)]
    for arm in told.arms:
        lives = sorted(world["organism_ticks"] / world["deaths"] for world in arms[arm.name])
        assert arm.life == (lives[(len(lives) - 1) // 2] + lives[len(lives) // 2]) / 2
        assert arm.life_interval is None
        assert arm.saturated == sum(world["saturation"] is not None for world in arms[arm.name])
    text = here("experiment", chosen.path, "--status").stdout
    assert "3 of 4 jobs done" in text
    shutil.rmtree(chosen.path / chosen.jobs[0].folder)
    assert begin(chosen.path).status().jobs["waiting"] == 2, "a run that was removed is not done"


@pytest.mark.slow
def test_some_arms_are_run_alone(tmp_path: Path) -> None:
    file, out = write(tmp_path), tmp_path / "out"
    done = here("experiment", file, "--out", out, "--only", "harsh", "--jobs", 1)
    assert done.returncode == 0
    assert " 0 of 2 jobs done" in done.stdout
    assert "2 jobs of other arms left to do" in done.stderr
    assert begin(out).status().jobs == {"done": 2, "running": 0, "failed": 0, "waiting": 2}
    assert begin(out).status(["harsh"]).jobs["waiting"] == 0
    assert [arm.name for arm in begin(out).status(["harsh"]).arms] == ["harsh"]
    assert not (out / "mild").exists()
    primordia.experiment(file, out, jobs=1, only=["harsh"])
    assert not (out / "results.md").exists()
    complains(here("compare", out), 2, f"arm mild of {out} has not begun yet")
    complains(here("replay", out), 2, f"{out} is an experiment; name one of its arms")


def test_a_job_that_another_process_lives_is_left_to_it(tmp_path: Path) -> None:

    chosen = begin(write(tmp_path), tmp_path / "out")
    run = chosen.path / chosen.jobs[0].folder
    loop.start(jobs.configuration(chosen.plan, chosen.jobs[0]), run)
    with directory.locked(run):
        assert jobs.ending_of(chosen.plan, chosen.jobs[0], chosen.path).state == "elsewhere"
        complains(here("experiment", chosen.path, "--job", 0), 2, "run by another process")


class Fated:
    """A place in which each job ends as foretold, try by try."""

    def __init__(self, *fates: list[Ending]) -> None:
        self.fates = fates

    def submit(self, job: Job) -> Future[Ending]:
        future: Future[Ending] = Future()
        future.set_result(self.fates[job.number].pop(0))
        return future

    def stop(self) -> None: ...


def test_a_job_whose_process_alone_is_stopped_goes_on(tmp_path: Path) -> None:
    """A place that stops each job once; the loop ends when all are done."""
    chosen = begin(write(tmp_path), tmp_path / "out")
    place = Fated(*([Ending(number, "stopped"), Ending(number, "done")] for number in range(4)))
    result = live_all(chosen.jobs, place, lambda: None, lambda *_: None)
    assert (result.done, result.stopped) == (4, False)


def test_each_job_that_might_succeed_is_tried_three_times(tmp_path: Path) -> None:
    """Neither failures of other jobs count, nor signals to the job's own process."""
    chosen, told = begin(write(tmp_path), tmp_path / "out"), list[tuple[int, bool]]()
    fail, lost = (lambda job: Ending(job, "failed")), Ending(1, "failed", again=False)
    signal = Ending(0, "stopped")
    done = [Ending(number, "done") for number in range(4)]
    place = Fated(
        [signal, signal, *[fail(0)] * 4],
        [lost] * 2,
        [fail(2), fail(2), done[2]],
        [fail(3), done[3]],
    )
    result = live_all(
        chosen.jobs, place, lambda: None, lambda job, _, again: told.append((job.number, again))
    )
    assert (result.done, [ending.job for ending in result.failed]) == (2, [1, 0])
    assert [len(fates) for fates in place.fates] == [1, 1, 0, 0]
    assert sorted(told) == [
        (0, False), (0, True), (0, True), (1, False), (2, True), (2, True), (3, True)
    ]  # fmt: skip


@pytest.mark.slow
def test_code_of_a_folder_from_elsewhere_is_not_executed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A job of somewhere else may hold any code: it is not run where its module is not installed."""
    (tmp_path / "author").mkdir()
    monkeypatch.chdir(tmp_path / "author")
    source = (Path(toys.__file__)).read_text(encoding="utf-8")
    Path("strange_toys.py").write_text(source, encoding="utf-8")
    file = write(Path(), arms=[{"name": "all", "habitat": {"name": "strange_toys:Mill"}}])
    chosen = begin(file, tmp_path / "out")
    job, config = chosen.jobs[0], jobs.configuration(chosen.plan, chosen.jobs[0])
    stop = config.stop.model_copy(update={"ticks": 5})
    loop.start(config.model_copy(update={"stop": stop}), chosen.path / job.folder)
    (tmp_path / "reader").mkdir()
    Path("strange_toys.py").unlink()
    here_ = {**commands.environment(), "XDG_STATE_HOME": str(tmp_path / "state")}

    def lived(*options: str) -> subprocess.CompletedProcess[str]:
        words = ["primordia", "experiment", str(chosen.path), "--job", "0", *options]
        script = f"import sys; from primordia.cli import main; sys.argv = {words}; main()"
        return subprocess.run(
            [sys.executable, "-P", "-c", script],
            cwd=tmp_path / "reader",
            env=here_,
            capture_output=True,
            text=True,
        )

    done = lived()
    assert done.returncode == 1
    assert "executes code that Primordia does not know" in done.stderr
    assert lived("--trust").returncode == 0
