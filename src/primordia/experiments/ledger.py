"""The ledger: for each job a small file with its state, which the job's process writes at intervals.

Any machine can read states and counts from these files, without opening a run. A job is done if its file
says so and its run exists. If the file of a done job is lost, the job is resumed and ends at once.
"""

import json
import os
import socket
import time
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, ValidationError

from primordia import files
from primordia.experiments.plan import Job

FOLDER = "jobs"
SILENT = 600.0
"""Seconds without an update after which a job on another machine counts as interrupted."""
State = Literal["waiting", "running", "done", "failed"]
Count = Annotated[int, Field(ge=0, lt=2**64)]


class WorldCounts(BaseModel):
    """The counts of a world."""

    model_config = ConfigDict(extra="forbid", strict=True)

    seed: Count
    ticks: Count
    births: Count
    deaths: Count
    organism_ticks: Count
    saturated: Count | None
    """tick of saturation, or None"""


class Entry(BaseModel):
    """The state of a job."""

    model_config = ConfigDict(extra="forbid", strict=True)

    job: int
    arm: str
    state: State = "waiting"
    error: str | None = None
    worlds: list[WorldCounts] = Field([])
    rate: FiniteFloat | None = None
    """organism-ticks per second, in recent seconds"""
    left_s: FiniteFloat | None = None
    """seconds until the last world reaches a limit; None if unknown"""
    updated: FiniteFloat = 0.0
    """seconds since 1970"""
    host: str = ""
    process: int = Field(0, ge=0, lt=2**31)


class Ledger:
    """The entries of all jobs; the entry of a job that is done is read only once."""

    def __init__(self, out: Path, jobs: list[Job]) -> None:
        self._folder, self._out = out / FOLDER, out
        self._jobs = jobs
        self._done: dict[int, Entry] = {}

    def entries(self) -> list[Entry]:
        """Return the entry of each job, in the order of the jobs."""
        try:
            there = set(os.listdir(self._folder))
        except OSError:
            there = set()
        return [
            self.entry(job) if self._file(job).name in there else _nothing_of(job)
            for job in self._jobs
        ]

    def entry(self, job: Job) -> Entry:
        """Return the present entry of a job."""
        if (known := self._done.get(job.number)) is not None:
            return known
        entry = self._read(job)
        if entry.state == "done" and (self._out / job.folder).is_dir():
            self._done[job.number] = entry
        elif entry.state in ("done", "running") and not _is_lived(entry):
            entry.state = "waiting"
        return entry

    def _read(self, job: Job) -> Entry:
        try:
            entry = Entry.model_validate_json(files.read(self._file(job)))
        except (OSError, ValidationError):
            return _nothing_of(job)
        return entry if (entry.job, entry.arm) == (job.number, job.arm) else _nothing_of(job)

    def write(self, job: Job, entry: Entry) -> None:
        """Write the entry of a job.

        Raises:
            Trouble: the entry cannot be written.
        """
        entry.updated, entry.host, entry.process = time.time(), socket.gethostname(), os.getpid()
        files.own_folder(self._folder)
        files.replace_text(self._file(job), json.dumps(entry.model_dump()))

    def _file(self, job: Job) -> Path:
        return self._folder / f"{job.number:06d}.json"


def _nothing_of(job: Job) -> Entry:
    """Return the entry of a job without a file."""
    return Entry(job=job.number, arm=job.arm)


def _is_lived(entry: Entry) -> bool:
    """Return whether the process that writes an entry seems to be alive."""
    if entry.state != "running" or entry.process == 0:
        return False
    if entry.host != socket.gethostname():
        return time.time() - entry.updated < SILENT
    try:
        os.kill(entry.process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        pass  # a process of another user
    return True
