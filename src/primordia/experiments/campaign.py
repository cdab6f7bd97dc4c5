"""Campaigns: an experiment in its directory, its jobs, their status, and the results."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from primordia.comparison.differing import differing
from primordia.errors import InputError
from primordia.experiments import file as files_of_users
from primordia.experiments import plan as plans
from primordia.experiments.ledger import Ledger
from primordia.experiments.plan import Job, Plan
from primordia.experiments.status import CampaignStatus, status
from primordia.history.info import info
from primordia.runs import checkpoint
from primordia.runs.opening import EXPERIMENT, opened
from primordia.runs.records import Records

RESULTS = "results"
"""Stem of the names of the result files in an experiment's directory."""


class Campaign:
    """An experiment in a directory."""

    def __init__(self, path: Path, plan: Plan) -> None:
        """Take a directory and its plan; `begin` and `recorded` call this."""
        self.path, self.plan = path, plan
        self.jobs = plan.jobs()
        self._ledger = Ledger(path, self.jobs)

    @property
    def arms(self) -> dict[str, Path]:
        """Name of each arm -> the folder of its runs; the first arm is the reference."""
        return {arm.name: self.path / arm.name for arm in self.plan.arms}

    def runs(self) -> dict[str, list[Path]]:
        """Return, by name of the arm, the directories of the arm's runs that have a checkpoint."""
        runs: dict[str, list[Path]] = {name: [] for name in self.arms}
        for job in self.jobs:
            if checkpoint.exists(path := self.path / job.folder):
                runs[job.arm].append(path)
        return runs

    def job(self, number: int) -> Job:
        """Return a job by its number; raise InputError if there is none."""
        if not 0 <= number < len(self.jobs):
            raise InputError(
                f"{self.path} has no job {number}; the jobs are 0 to {len(self.jobs) - 1}"
            )
        return self.jobs[number]

    def left(self, arms: Sequence[str] = ()) -> list[Job]:
        """Return the jobs of some arms that are not done; without `arms`, those of all arms.

        Arms take turns: first the first job of each arm, then the second job of each arm, ...

        Raises:
            InputError: there is no such arm.
        """
        names = self._names(arms)
        left = [
            job for job in self.jobs if job.arm in names and self._ledger.entry(job).state != "done"
        ]
        return sorted(left, key=lambda job: job.first)

    def status(self, arms: Sequence[str] = ()) -> CampaignStatus:
        """Return the number of jobs in each state, and the counts of each arm so far.

        Without `arms`, these are the jobs and counts of all arms.

        Raises:
            InputError: there is no such arm.
        """
        names = self._names(arms)
        entries = [entry for entry in self._ledger.entries() if entry.arm in names]
        return status(self.plan, entries, names)

    def _names(self, arms: Sequence[str]) -> set[str]:
        """Return the names of some arms; without `arms`, those of all arms."""
        return {self.plan.arm(name).name for name in arms or self.arms}

    def opened(self) -> list[Records]:
        """Open the runs of each arm for reading.

        Raises:
            InputError: nothing has lived in an arm yet.
        """
        for name, folder in self.arms.items():
            if not folder.is_dir():
                raise InputError(f"arm {name} of {self.path} has not begun yet")
        return [opened([folder]) for folder in self.arms.values()]

    def gather(self) -> list[Path]:
        """Write the results of all arms. Return the files."""
        from primordia.experiments import results  # Matplotlib takes a second to load

        return results.write(self.path / RESULTS, self.plan.question, self.opened())

    def info(self) -> dict[str, Any]:
        """Return the question, the number of jobs in each state, and the worlds of each arm.

        For each arm, only settings in which the arms differ are returned.
        """
        settings = differing([arm.config for arm in self.plan.arms])
        arms = [
            {"name": name, "settings": own, "worlds": _worlds(folder)}
            for (name, folder), own in zip(self.arms.items(), settings, strict=True)
        ]
        return {"question": self.plan.question, "jobs": self.status().jobs, "arms": arms}


def _worlds(folder: Path) -> list[dict[str, Any]]:
    """Return the worlds of an arm that have begun, as in the `info` of a run."""
    try:
        return list(info(opened([folder]))["worlds"])
    except InputError:
        return []


def is_experiment(path: Path) -> bool:
    """Return whether a path is the directory of an experiment."""
    return (path / EXPERIMENT).is_file()


def recorded(path: Path) -> Campaign:
    """Return the experiment in a directory; raise InputError if there is none."""
    return Campaign(path, plans.recorded(path))


def planned(file: Path, out: Path | None = None) -> Campaign:
    """Return the experiment of a file or a directory, without writing anything.

    Args:
        file: an experiment's file, or the directory of an experiment that has begun.
        out: the directory; by default the file's name under `runs/`.

    Raises:
        InputError: the file has a fault, or the directory holds another experiment.
    """
    if is_experiment(file):
        return recorded(file)
    out = out if out is not None else Path("runs", file.stem)
    plan = files_of_users.read(file, out)
    plans.check(plan, out)
    return Campaign(out, plan)


def begin(file: Path, out: Path | None = None) -> Campaign:
    """Return an experiment, and make its directory if it is new; see `planned`.

    Raises:
        InputError: see `planned`.
        Trouble: the directory cannot be written.
    """
    chosen = planned(file, out)
    plans.write(chosen.plan, chosen.path)
    return chosen
