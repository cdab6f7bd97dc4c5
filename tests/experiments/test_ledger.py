"""The ledger's entries of jobs: the process that runs a job, the counts of its worlds, and its end."""

import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import pytest

import primordia
from primordia.errors import InputError, InUseError, Trouble
from primordia.experiments import job as jobs
from primordia.experiments.campaign import begin
from primordia.experiments.ledger import SILENT, Entry, Ledger, WorldCounts
from primordia.experiments.plan import Ending, Job
from tests.experiments.meadows import write

JOB = Job(0, "a", 0, 1, "a/0")
COUNTS = WorldCounts(seed=1, ticks=2, births=3, deaths=4, organism_ticks=5, saturated=None)


@pytest.fixture(scope="module")
def ended() -> int:
    """Return the number of a process that has ended."""
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


def state_of(folder: Path, **values: Any) -> str:
    """Return the state of the job whose file has these values."""
    (folder / "jobs").mkdir(exist_ok=True)
    (folder / "jobs" / "000000.json").write_text(json.dumps({"job": 0, "arm": "a", **values}))
    (entry,) = Ledger(folder, [JOB]).entries()
    return entry.state


def test_a_job_runs_while_its_process_lives_or_its_machine_is_not_silent(
    tmp_path: Path, ended: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """This machine sees its own processes, whatever the age of the file, but not those of others."""
    monkeypatch.setattr("primordia.experiments.ledger.time.time", lambda: 50_000.0)
    here = socket.gethostname()
    for host, process, age, state in (
        (here, os.getpid(), 49_999, "running"),
        (here, ended, 0, "waiting"),
        (here, 0, 0, "waiting"),
        ("elsewhere", ended, SILENT - 1, "running"),
        ("elsewhere", ended, SILENT, "waiting"),
    ):
        written: dict[str, Any] = {"host": host, "process": process, "updated": 50_000.0 - age}
        assert state_of(tmp_path, state="running", **written) == state
    monkeypatch.setattr(os, "kill", MagicMock(side_effect=PermissionError))  # of another user
    assert state_of(tmp_path, state="running", host=here, process=7, updated=1.0) == "running"


def test_a_failed_job_stays_failed_and_a_done_job_has_a_run(tmp_path: Path, ended: int) -> None:
    written = {"host": socket.gethostname(), "process": ended, "updated": 1.0}
    assert state_of(tmp_path, state="failed", **written) == "failed"
    assert state_of(tmp_path, state="done", **written) == "waiting"
    (tmp_path / "a" / "0").mkdir(parents=True)
    assert state_of(tmp_path, state="done", **written) == "done"


def test_an_entry_names_its_writer_and_a_failure_is_noted_beside_the_counts_so_far(
    tmp_path: Path,
) -> None:
    before = time.time()
    ledger = Ledger(tmp_path, [JOB])
    ledger.write(JOB, Entry(job=0, arm="a", state="running", worlds=[COUNTS], rate=2.0))
    found = ledger.entry(JOB)
    assert (found.state, found.host, found.process) == (
        "running", socket.gethostname(), os.getpid(),
    )  # fmt: skip
    assert before <= found.updated <= time.time()
    jobs.note_failure(JOB, tmp_path, "the disk is full")
    found = ledger.entry(JOB)
    assert (found.state, found.error) == ("failed", "the disk is full")
    assert (found.worlds, found.rate) == ([COUNTS], 2.0)


@pytest.mark.parametrize(
    ("error", "ending"),
    [
        (None, Ending(0, "done")),
        (KeyboardInterrupt(), Ending(0, "stopped")),
        (InUseError("locked"), Ending(0, "elsewhere")),
        (InputError("no"), Ending(0, "failed", "no", again=False)),
        (Trouble("full"), Ending(0, "failed", "full", again=True)),
        (OSError("gone"), Ending(0, "failed", "gone", again=True)),
        (ValueError("one\ntwo"), Ending(0, "failed", "ValueError: one", again=True)),
    ],
    ids=lambda value: type(value).__name__,
)
def test_an_error_is_an_ending_and_failures_are_on_record(
    error: BaseException | None, ending: Ending, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []

    def live(*words: Any) -> None:
        asked.append(words)
        if error is not None:
            raise error

    monkeypatch.setattr(jobs, "live", live)
    plan: Any = "the plan"
    assert jobs.ending_of(plan, JOB, tmp_path, 7.0, "gpu") == ending
    assert asked == [(plan, JOB, tmp_path, 7.0, "gpu")]
    found = Ledger(tmp_path, [JOB]).entry(JOB)
    expected = ("failed", ending.error) if ending.state == "failed" else ("waiting", None)
    assert (found.state, found.error) == expected


def test_a_running_job_writes_the_counts_of_each_of_its_worlds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The last counts before the end are those of the run, and the time left is then 0."""
    written: list[Entry] = []
    write_entry = Ledger.write

    def noted(self: Ledger, job: Job, entry: Entry) -> None:
        written.append(entry.model_copy())
        write_entry(self, job, entry)

    monkeypatch.setattr(Ledger, "write", noted)
    monkeypatch.setattr(jobs, "EVERY", 0.0)
    chosen = begin(write(tmp_path), tmp_path / "out")
    jobs.live(chosen.plan, chosen.jobs[2], chosen.path)
    first, *_, last, done = written
    assert [each.state for each in (first, last, done)] == ["running", "running", "done"]
    assert {(each.job, each.arm) for each in written} == {(2, "harsh")}
    assert first.worlds == []
    worlds = primordia.load(chosen.path / chosen.jobs[2].folder).info()["worlds"]
    names = "seed", "ticks", "births", "deaths", "organism_ticks"
    expected = [
        WorldCounts(
            **{name: world[name] for name in names},
            saturated=world["saturation"] and world["saturation"]["tick"],
        )
        for world in worlds
    ]
    assert [each.seed for each in expected] == [3, 4]
    assert len({each.deaths for each in expected}) == 2
    assert done.worlds == expected
    assert last.worlds == expected
    assert last.left_s == 0
    assert last.rate
    assert (done.rate, done.left_s) == (None, None), "a job that is done has no speed"


def test_the_counts_of_a_job_that_is_done_are_those_of_its_run(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    names = "seed", "ticks", "births", "deaths", "organism_ticks"
    counts = [dict(zip(names, range(first, first + 5), strict=True)) for first in (10, 20)]
    ends: list[Any] = [None, {"tick": 7, "births": 8}]
    worlds = [{**each, "saturation": end} for each, end in zip(counts, ends, strict=True)]
    archive: Any = "the run"
    monkeypatch.setattr(jobs, "info", lambda run: {"worlds": worlds} if run is archive else None)
    assert jobs._worlds(archive) == [
        WorldCounts(**each, saturated=tick) for each, tick in zip(counts, (None, 7), strict=True)
    ]


def test_counts_are_written_at_intervals(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first counts are written at once, and the next when the interval has passed."""
    now, written = [100.0], list[float]()
    monkeypatch.setattr("primordia.experiments.job.time.perf_counter", lambda: now[0])
    monkeypatch.setattr("primordia.experiments.job.Census.of", MagicMock())
    monkeypatch.setattr(jobs, "Speed", MagicMock())
    ledger = MagicMock()
    ledger.write = lambda *_: written.append(now[0])
    watch, status = jobs._Watch(ledger, JOB, MagicMock()), MagicMock()
    for seconds in (0.0, 1.0, jobs.EVERY - 0.01, jobs.EVERY, 2.5, 2 * jobs.EVERY):
        now[0] = 100 + seconds
        watch(status)
    assert written == [100, 100 + jobs.EVERY, 100 + 2 * jobs.EVERY]
