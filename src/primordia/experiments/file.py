"""The file of an experiment, written by a user: a question, shared settings, and arms.

question = "Does heredity matter?"
task = "CartPole-survival"
seeds = 100

[[arms]]
name = "heredity"

[[arms]]
name = "no-heredity"
inheritance = "founder"

The first arm is the reference. `[jobs] worlds` is the number of worlds of one job. If the file has
a table `[fork]`, all arms are forks. The key named `of` gives their source: a run, an arm's folder,
or an arm of another file in the same folder (`other/arm`). The key named `at` gives the tick of the
fork.
"""

import os
from itertools import pairwise
from pathlib import Path
from typing import Any

from pydantic import Field, ValidationError

from primordia import config
from primordia.config import Config
from primordia.errors import InputError
from primordia.experiments import plan as plans
from primordia.experiments.plan import ArmPlan, Fork, Plan, Source
from primordia.runs import bundle, opening
from primordia.runs.archive import Archive
from primordia.settings.base import UNREACHED, Settings
from primordia.settings.fields import first_fault
from primordia.settings.tables import (
    NONE,
    did_you_mean,
    from_toml,
    merged,
    relative_to,
    replaced,
    values_of,
)

BY_TENS = 10
"""Number of worlds of a job with a habitat in JAX, where the worlds of a run share each compiled
call. With a habitat on the host, simulators take nearly all of the time, so a job has one
world."""


class _Jobs(Settings):
    worlds: int | None = Field(None, ge=1)


class _ForkOf(Settings):
    of: str = Field(min_length=1)
    at: int = Field(ge=1, lt=UNREACHED)


class _Own(Settings):
    """The keys of an experiment's file that are not settings of a run."""

    question: str = ""
    arms: list[dict[str, Any]] = Field(min_length=1)
    jobs: _Jobs = _Jobs()
    fork: _ForkOf | None = None


def read(file: Path, out: Path, forks: tuple[Path, ...] = ()) -> Plan:
    """Return the plan of an experiment from its file.

    Args:
        file: the experiment's file.
        out: the directory of the experiment; it need not exist yet.
        forks: files of the experiments that fork this one, and of those that fork these.

    Raises:
        InputError: the file cannot be read or has a fault; the message says which.
    """
    if (here := file.resolve()) in forks:
        raise InputError(f"{file} is a fork of itself, directly or through other experiments")
    values = from_toml(file)
    given = {name: values.pop(name) for name in _Own.model_fields if name in values}
    _refuse_unknown(values, file)
    try:
        own = _Own.model_validate(given)
    except ValidationError as error:
        raise InputError(f"{file}: {first_fault(error, _Own)}") from None
    fork, sources = own.fork, None
    if fork is not None:
        base, sources = _origin(fork, file, out, (*forks, here))
        if {"task", "seeds", "cells"} & {*values, *(name for arm in own.arms for name in arm)}:
            raise InputError(
                f"{file}: a fork takes task, seeds and cells from {fork.of}; remove these settings"
            )
        values = merged(base, values)
    elif "task" not in values:
        raise InputError(f"{file}: `task` is missing; set it to the name of a task, or a file")
    chosen = [_arm(values, arm, file, fork is not None) for arm in own.arms]
    worlds = own.jobs.worlds or _recorded_worlds(out) or _default_worlds(chosen[0].config)
    try:
        return Plan(question=own.question, worlds=worlds, fork=sources, arms=tuple(chosen))
    except ValidationError as error:
        raise InputError(f"{file}: {first_fault(error, Plan)}") from None


def _refuse_unknown(values: dict[str, Any], file: Path) -> None:
    known = [*_Own.model_fields, *Config.model_fields]
    for name in values:
        if name not in known or name == "fork":
            raise InputError(f"{file}: there is no setting {name!r}{did_you_mean(name, known)}")


def _arm(shared: dict[str, Any], own: dict[str, Any], file: Path, complete: bool) -> ArmPlan:
    """Return an arm with all its settings, checked together.

    Args:
        shared: the settings of all arms: every setting if `complete`, else those that differ from
            the task's.
        own: the settings that differ in this arm, and its name.
        file: the experiment's file.
        complete: see `shared`.
    """
    own = relative_to(file.parent, own)
    name = own.pop("name", None)
    if name is None:
        raise InputError(f"{file}: an [[arms]] table has no `name`")
    if own.get("task", shared["task"]) != shared["task"]:
        raise InputError(f"{file}: arm {name!r} has another task; all arms must have the same task")
    values = merged(shared, own)
    beside = file.parent / str(values["task"])
    task = str(beside) if beside.is_file() else str(values["task"])
    try:
        if complete:
            chosen = config.validated(values, str(file))
        else:
            chosen = config.load(task, {**values, "task": values_of(task).get("task", task)})
    except InputError as error:
        raise InputError(f"{file}: arm {name!r}: {error}") from None
    settings = replaced(chosen.model_dump(mode="json"), None, NONE)
    settings["ancestors"] = [str(Path(genomes).resolve()) for genomes in chosen.ancestors]
    try:
        return ArmPlan(name=name, settings=settings)
    except ValidationError as error:
        raise InputError(f"{file}: arm {name!r}: {first_fault(error, ArmPlan)}") from None


def _origin(
    fork: _ForkOf, file: Path, out: Path, forks: tuple[Path, ...]
) -> tuple[dict[str, Any], Fork]:
    """Return the settings of the forked worlds, and their runs."""
    other, _, arm = fork.of.partition("/")
    try:
        if (sibling := file.with_name(f"{other}.toml")).is_file() and arm:
            settings, runs = _of_experiment(sibling, out.parent / other, arm, forks)
        else:
            settings, runs = _of_runs(Path(fork.of))
    except InputError as error:
        raise InputError(f"{file}: fork.of: {error}") from None
    sources = [Source(run=os.path.relpath(run, out), worlds=worlds) for run, worlds in runs]
    del settings["fork"]
    return settings, Fork(at=fork.at, sources=tuple(sources))


def _of_experiment(
    file: Path, out: Path, arm: str, forks: tuple[Path, ...]
) -> tuple[dict[str, Any], list[tuple[Path, int]]]:
    """Return the settings of another experiment's arm, and its runs, each with its number of worlds."""
    begun = (out / opening.EXPERIMENT).is_file()
    plan = plans.recorded(out) if begun else read(file, out, forks)
    runs = [(out / job.folder, job.worlds) for job in plan.jobs() if job.arm == arm]
    return dict(plan.arm(arm).settings), runs


def _of_runs(place: Path) -> tuple[dict[str, Any], list[tuple[Path, int]]]:
    """Return the settings of runs of one arm, and the runs, each with its number of worlds."""
    paths = opening.opened([place]).paths
    if packed := [origin for path in paths if (origin := bundle.origin_of(path)) != path]:
        raise InputError(f"{packed[0]} is a bundle; make it a run again with `primordia unbundle`")
    configs = [Archive(path).config for path in paths]
    for one, after in pairwise(configs):
        if (following := one.seed + one.seeds) != after.seed:
            raise InputError(
                f"its runs have no world of seed {following}, but one of {after.seed}; an arm has"
                " successive seeds, so fork some of the runs by a pattern"
            )
    settings = configs[0].on_copies(replaced(configs[0].model_dump(mode="json"), None, NONE))
    settings["seeds"] = sum(each.seeds for each in configs)
    settings["ancestors"] = [str(paths[0] / genomes) for genomes in configs[0].ancestors]
    return settings, [(path, each.seeds) for path, each in zip(paths, configs, strict=True)]


def _recorded_worlds(out: Path) -> int | None:
    """Return the number of worlds of a job in an experiment; None if it has not begun."""
    return plans.recorded(out).worlds if (out / opening.EXPERIMENT).is_file() else None


def _default_worlds(chosen: Config) -> int:
    return 1 if chosen.build_habitat().kind == "host" else BY_TENS
