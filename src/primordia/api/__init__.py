"""The Python interface, on which the command line is built.

import primordia

run = primordia.run("CartPole-survival", out="runs/first", seed=1)
print(run.info()["saturation"])
run.resume(ticks=200_000, until="none")
policy = run.oldest().policy()
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from primordia import config
from primordia import device as devices
from primordia.api.experiments import Experiment
from primordia.api.runs import Run, fresh_directory
from primordia.comparison import comparison
from primordia.errors import InputError, Trouble
from primordia.experiments import campaign as campaigns
from primordia.experiments.campaign import is_experiment
from primordia.experiments.dispatch import live_all, place_for
from primordia.experiments.status import CampaignStatus
from primordia.runs import code, loop, opening
from primordia.runs.archive import Archive
from primordia.runs.loop import Listener
from primordia.runs.records import Records

__all__ = [
    "Experiment",
    "Run",
    "compare",
    "default_name",
    "experiment",
    "fresh_directory",
    "load",
    "run",
]


def run(
    task: str | Path,
    out: str | Path | None = None,
    settings: Mapping[str, Any] | None = None,
    *,
    resume: bool = False,
    checkpoint_every: float = 60.0,
    device: str = "cpu",
    listen: Listener | None = None,
    **more: Any,
) -> Run:
    """Run a task until its worlds stop.

    Args:
        task: name of a built-in task, or a TOML file.
        out: directory of the new run; by default a new directory under `runs/`.
        resume: if `out` already holds a run, go on with that run instead of raising InputError.
        checkpoint_every: seconds from one checkpoint to the next.
        device: `cpu` or `gpu`. All devices of this kind are used if the number of worlds allows
            it; see `device.sharing`.
        listen: a function that is called after each chunk.
        settings: changed settings, with tables as dicts: `{"cells": 64, "mutation": {"scale":
            0.02}}`.
        more: further changed settings as keywords: `cells=64, mutation={"scale": 0.02}`.

    Raises:
        InputError: a name or setting is wrong, or `out` is taken.
        Trouble: a file cannot be written; earlier checkpoints stay good.
        KeyboardInterrupt: on Ctrl-C, after a checkpoint.
    """
    with devices.selected(device):
        chosen = config.load(task, {**(settings or {}), **more})
        if resume and out is None:
            raise InputError(
                "resume needs the directory of the run; give `out` (--out on the command line)"
            )
        path = Path(out) if out is not None else fresh_directory(default_name(chosen))
        live = loop.begin_or_resume if resume else loop.start
        live(chosen, path, checkpoint_every=checkpoint_every, listen=listen)
    return Run(path)


def experiment(
    file: str | Path,
    out: str | Path | None = None,
    *,
    jobs: int | None = None,
    only: Sequence[str] = (),
    ray: str | None = None,
    checkpoint_every: float = 60.0,
    device: str = "cpu",
    look: Callable[[CampaignStatus], object] | None = None,
) -> Experiment:
    """Begin or resume an experiment, run its jobs on all cores, and write the results.

    Args:
        file: an experiment's TOML file, or the directory of an experiment that has begun.
        out: the experiment's directory; by default the file's name under `runs/`.
        jobs: number of jobs that run at once; by default one for each core.
        only: names of the arms to run; by default all arms.
        ray: address of a Ray cluster to run on; "" for this machine's cluster, or for a new cluster
            if there is none. By default no cluster is used.
        checkpoint_every: seconds from one checkpoint to the next.
        device: the device that JAX computes on, `cpu` or `gpu`.
        look: a function that is called about twice a second with the status.

    Raises:
        InputError: something in the file is wrong, or `out` holds another experiment.
        Trouble: some jobs failed; all other jobs are done.
        KeyboardInterrupt: on Ctrl-C, after checkpoints.
    """
    chosen = campaigns.begin(Path(file), Path(out) if out is not None else None)
    if left := chosen.left(only):
        place = place_for(chosen.path, len(left), jobs, ray, checkpoint_every, device)
        seen = (lambda: look(chosen.status())) if look is not None else (lambda: None)
        result = live_all(left, place, seen, lambda job, ending, again: None)
        if result.stopped:
            raise KeyboardInterrupt
        if result.failed:
            first = result.failed[0]
            raise Trouble(f"failed jobs: {len(result.failed)}; job {first.job}: {first.error}")
    if not chosen.left():
        chosen.gather()
    return Experiment(chosen.path)


def compare(
    *runs: Run | str | Path,
    births: int | None = None,
    ticks: int | None = None,
    island: str | None = None,
) -> comparison.Comparison:
    """Compare runs or arms of one task with the first of them; see `comparison.compare`.

    Args:
        runs: each is a run's directory; an arm's folder; `name=PATTERN`, such as
            `heredity=runs/h*`, for several runs as one arm; or an experiment's directory, for all
            arms of the experiment.
        births: horizon in births; see `comparison.compare`.
        ticks: horizon in ticks, in the same way.
        island: name of an island; only organisms that were born on it count.

    `figures.comparison.save` draws the result.
    """
    arms = [arm for each in runs for arm in _arms(each)]
    if len(arms) < 2:
        raise InputError(
            "compare needs two or more runs, or an experiment of two or more arms; the first is the"
            " reference of the others"
        )
    return comparison.compare(arms, births, ticks, island)


def _arms(place: Run | str | Path) -> list[Records]:
    if isinstance(place, Experiment):
        return place.records()
    if isinstance(place, Run):
        return [place.opened()]
    if is_experiment(Path(place)):
        return Experiment(Path(place)).records()
    name, path = opening.split_name(str(place))
    return [opening.opened([path], name)]


def load(run: str | Path | Sequence[str | Path], trust: bool = False) -> Run:
    """Return the run in a directory or a bundle, several runs as one arm, or an experiment.

    Args:
        run: a run's directory; a run's bundle; a folder that holds runs; a pattern, such as
            `runs/h*`; several of these; or the directory of an experiment, which gives an
            `Experiment`.
        trust: allow Primordia to execute the run's own code on this machine from now on. If the
            user has already begun a run with the same code, no permission is needed. With other
            code and no permission, `resume`, `fork`, `verify`, `replay`, `relive`, `evaluate` and
            `policy` raise InputError. Reading records executes nothing.

    Raises:
        InputError: there is no run, or the runs do not belong to one arm.
    """
    places = [run] if isinstance(run, str | Path) else list(run)
    if not places:
        raise InputError("no run is given")
    first, *others = map(Path, places)
    loaded = Experiment(first) if is_experiment(first) and not others else Run(first, tuple(others))
    for path in loaded.directories():
        if trust:
            code.trust(Archive(path).code())
            code.trust(Archive(path, edited=True).code())
    return loaded


def default_name(chosen: config.Config) -> str:
    """Return a name for a run's directory, made of the task's name and the seed."""
    task = "".join(each if each.isprintable() and each != "/" else "-" for each in chosen.task)
    return f"{task}-seed{chosen.seed}"
