"""The plan of an experiment: its question, its arms, and the jobs that divide their worlds.

OUT/experiment.toml      the plan, written once
    ARM/000-009/         a job: the run of an arm's worlds 0 to 9
    jobs/000012.json     the state of a job; see `ledger`
"""

import os
import socket
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, Self

import tomli_w
from pydantic import Field, ValidationError, model_validator

from primordia import files
from primordia.config import Config, parsed
from primordia.errors import InputError
from primordia.runs.opening import EXPERIMENT
from primordia.settings.base import UNREACHED, Settings
from primordia.settings.fields import first_fault
from primordia.settings.tables import flat, from_toml

LOG = "workers.log"
"""The file in the experiment's directory with the output of workers and their libraries."""
OWN_FILES = EXPERIMENT, LOG, "results.md", "results.csv", "results.png"
RESERVED = {"jobs", "figures", *OWN_FILES}
"""Names in an experiment's folder that no arm can have."""
LARGEST = 100_000
"""Largest number of jobs of an experiment."""


class Source(Settings):
    """A run whose worlds a job continues."""

    run: str
    """the run's directory, relative to the experiment's directory"""
    worlds: int = Field(ge=1)


class Fork(Settings):
    """The runs from which all arms are forked, and the tick of the fork."""

    at: int = Field(ge=1, lt=UNREACHED)
    sources: tuple[Source, ...] = Field(min_length=1, strict=False)


class ArmPlan(Settings):
    """An arm's name and all settings of its worlds."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 ._+-]*$", max_length=100)]
    settings: dict[str, Any]

    @property
    def config(self) -> Config:
        """The configuration of a single run with all worlds of the arm."""
        return parsed(self.settings, f"arm {self.name}")


@dataclass(frozen=True)
class Job:
    """Some worlds of an arm, in one run."""

    number: int
    arm: str
    first: int
    """number of the first world within the arm"""
    worlds: int
    folder: str
    """the run's directory, relative to the experiment's directory"""
    source: str | None = None
    """the run that the job forks, relative to the directory of the experiment"""


class Ending(NamedTuple):
    """The outcome of a job."""

    job: int
    state: Literal["done", "failed", "elsewhere", "stopped"]
    """elsewhere: another process runs the job; stopped: a signal came, and the job can go on"""
    error: str | None = None
    """the error in one line, if the job failed"""
    again: bool = True
    """whether another try may end otherwise; a request that cannot be carried out never does"""


class Plan(Settings):
    """A complete experiment."""

    question: str
    worlds: int = Field(ge=1)
    """number of worlds of a job"""
    fork: Fork | None = None
    arms: tuple[ArmPlan, ...] = Field(min_length=1, strict=False)

    @model_validator(mode="after")
    def _fits(self) -> Self:
        names = Counter(arm.name.casefold() for arm in self.arms)  # some file systems ignore case
        for name, count in names.items():
            if count > 1 or name in RESERVED:
                raise ValueError(
                    f"{name!r} cannot name an arm, or names two arms; choose another name"
                )
        sources, jobs = self.fork.sources if self.fork else (), 0
        worlds = sum(source.worlds for source in sources)
        for arm in self.arms:
            seeds = arm.settings.get("seeds")
            if type(seeds) is not int or not 1 <= seeds <= 2**16:
                raise ValueError(f"seeds of arm {arm.name} must be a whole number from 1 to 65536")
            if sources and seeds != worlds:
                raise ValueError(
                    f"arm {arm.name} has {seeds} worlds, and the runs that it forks have {worlds}"
                )
            jobs += len(sources) or -(-seeds // self.worlds)
        if jobs > LARGEST:
            raise ValueError(f"{jobs:,} jobs are more than {LARGEST:,}; raise jobs.worlds")
        return self

    def arm(self, name: str) -> ArmPlan:
        """Return the arm with a name; raise InputError if there is none."""
        for each in self.arms:
            if each.name == name:
                return each
        names = ", ".join(each.name for each in self.arms)
        raise InputError(f"there is no arm {name!r}; the arms are {names}")

    def jobs(self) -> list[Job]:
        """Return all jobs, arm by arm: jobs keep their numbers when there are further arms."""
        cuts = ((arm.name, *cut) for arm in self.arms for cut in self._cut(arm))
        return [Job(number, *values) for number, values in enumerate(cuts)]

    def _cut(self, arm: ArmPlan) -> Iterator[tuple[int, int, str, str | None]]:
        """Yield first world, number of worlds, folder and source of each of an arm's jobs."""
        worlds = int(arm.settings["seeds"])
        digits = len(str(worlds - 1))
        sizes = [self.worlds] * (worlds // self.worlds) + [worlds % self.worlds]
        sources: list[Source | None] = [None] * len(sizes)
        if self.fork is not None:
            sources = list(self.fork.sources)
            sizes = [source.worlds for source in self.fork.sources]
        first = 0
        for size, source in zip(sizes, sources, strict=True):
            if size:
                span = range(first, first + size)
                name = "-".join(f"{each:0{digits}}" for each in sorted({span[0], span[-1]}))
                yield first, size, f"{arm.name}/{name}", source.run if source else None
            first += size


def recorded(out: Path) -> Plan:
    """Return the plan in an experiment's directory.

    Raises:
        InputError: there is no plan, or the plan is damaged.
    """
    file = out / EXPERIMENT
    try:
        return Plan.model_validate(from_toml(file))
    except ValidationError as error:
        raise InputError(f"{file} is damaged: {first_fault(error, Plan)}") from None


def check(plan: Plan, out: Path) -> None:
    """Raise InputError if a directory holds something other than this experiment or its first arms."""
    files.check_name(out)
    if (out / EXPERIMENT).is_file():
        _refuse_other(plan, recorded(out), out)
    elif out.exists() and not (out.is_dir() and _is_empty(out)):
        raise InputError(f"{out} exists already and is not an experiment; choose another --out")


def _is_empty(out: Path) -> bool:
    """Return whether a folder is empty, but for a plan that another process writes at this moment."""
    return all(name.startswith((files.TEMPORARY, EXPERIMENT)) for name in os.listdir(out))


def write(plan: Plan, out: Path) -> None:
    """Write a plan that `check` accepts; if the directory has one, add the further arms alone.

    Raises:
        Trouble: the plan cannot be written."""
    files.make_folder(out)
    if (out / EXPERIMENT).is_file():
        there = recorded(out)
        if not (further := plan.arms[len(there.arms) :]):
            return
        plan = there.model_copy(update={"arms": (*there.arms, *further)})
    text = tomli_w.dumps(plan.model_dump(mode="json", exclude_none=True))
    own = f"{socket.gethostname()}-{os.getpid()}-"  # all jobs of an array may begin at once
    files.write(out / EXPERIMENT, lambda temporary: temporary.write_bytes(text.encode()), own=own)


def _refuse_other(plan: Plan, there: Plan, out: Path) -> None:
    """Raise InputError if two plans differ in more than the text of the question and further arms."""
    known, count = [arm.name for arm in there.arms], len(there.arms)
    if [arm.name for arm in plan.arms[:count]] != known:
        raise InputError(
            f"{out} holds an experiment with the arms {', '.join(known)}; write them first in this"
            " order, and further arms after them, or choose another --out"
        )
    ours, theirs = _named(plan.model_copy(update={"arms": plan.arms[:count]})), _named(there)
    for name in (*ours, *theirs):
        if ours.get(name) != theirs.get(name):
            raise InputError(
                f"{out} holds another experiment: {name} is {_shown(theirs.get(name))} there, and"
                f" {_shown(ours.get(name))} here; choose another --out"
            )


def _named(plan: Plan) -> dict[str, Any]:
    """Return the values in which two plans may differ, by dotted name."""
    values = plan.model_dump(mode="json", exclude={"question", "arms"})
    arms = {arm.name: {**arm.settings, "about": ""} for arm in plan.arms}
    return flat({**values, "arms": arms})


def _shown(value: Any) -> str:
    return "missing" if value is None else str(value)
