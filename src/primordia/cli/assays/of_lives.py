"""Assays in which organisms live again."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.assays.options import Found, assay, games_option, source_argument, ticks_option
from primordia.cli.numbers import COUNT, Finite

if TYPE_CHECKING:
    from primordia.assays.subjects import Subjects

SUFFIX = ".safetensors"
"""The suffix of a genome file."""

organisms_argument = click.argument("organisms", type=int, nargs=-1, metavar="[ID]...")
world_option = click.option(
    "--world", type=int, help="The organisms' world [0 if an ID is given, otherwise see above]."
)
task_option = click.option(
    "--task", help="Task in which the genomes of a file live [the task that the file names]."
)
SUBJECTS = (source_argument, organisms_argument, world_option)
GAMES = (games_option, ticks_option)


@assay(
    "Measure how mutations of several sizes change a life.",
    click.option(
        "--mutants", type=COUNT, default=24, show_default=True,
        help="Number of mutants of each organism, for each mutation.",
    ),
    click.option(
        "--scale", "scales", type=Finite(min=0, min_open=True, max=1e30), multiple=True,
        help="Standard deviation of the noise, as a multiple of the founders' standard deviation; may be"
        " repeated [0.001 0.003 0.01 0.03 0.1 0.3].",
    ),
    click.option(
        "--differs", type=Finite(min=0), multiple=True,
        help="Also measure a calibrated mutation that changes behaviour by this share; may be repeated.",
    ),
    *SUBJECTS,
    task_option,
    *GAMES,
    settings=True,
)  # fmt: skip
def effects(
    habitat: dict[str, Any],
    /,
    mutants: int,
    scales: tuple[float, ...],
    differs: tuple[float, ...],
    games: int,
    ticks: int,
    **chosen: Any,
) -> Found:
    """Measure several kinds of mutation: let mutants play the same games as their parents.

    RUN is a run, a genome file or a task. Without an ID, the parents are the champions of a run's
    worlds, all genomes of a file, or the 16 longest-lived of 512 founders of a task. The first row
    of the table is the run's own mutation. Any setting of the habitat can be changed by a flag,
    such as --sticky 0.25.
    """
    from primordia.assays.effects import SCALES
    from primordia.assays.effects import effects as measure

    subjects = subjects_of(habitat, **chosen)
    return {subjects.source: measure(subjects, scales or SCALES, differs, mutants, games, ticks)}


@assay(
    "Measure how a life depends on senses, memory, learning and weights.",
    click.option("--each-sense", is_flag=True, help="Also freeze each sense alone."),
    *SUBJECTS,
    task_option,
    *GAMES,
    settings=True,
)
def ablate(
    habitat: dict[str, Any], /, each_sense: bool, games: int, ticks: int, **chosen: Any
) -> Found:
    """Let organisms live again with one part switched off: senses, memory, plasticity (of
    brains that learn), or a block of weights.

    RUN is a run, a genome file or a task. Without an ID, these organisms are the champions of a
    run's worlds, all genomes of a file, or the 16 longest-lived of 512 founders of a task. Any
    setting of the habitat can be changed by a flag, such as --sticky 0.25.
    """
    from primordia.assays.ablate import ablate as measure

    subjects = subjects_of(habitat, **chosen)
    return {subjects.source: measure(subjects, each_sense, games, ticks)}


def subjects_of(
    habitat: dict[str, Any],
    run: Path,
    organisms: tuple[int, ...],
    world: int | None,
    task: str | None,
    trust: bool,
) -> "Subjects":
    """Return the subjects that a command names: organisms of a run, genomes of a file, or founders."""
    from primordia.api import load
    from primordia.assays.subjects import of_file, of_run, of_task
    from primordia.errors import InputError
    from primordia.settings.doors import is_door
    from primordia.settings.tables import tasks

    named = str(run) in tasks() or is_door(str(run))
    of_a_task = run.suffix == ".toml" or (named and not run.exists())
    if world is not None and (of_a_task or run.suffix == SUFFIX):
        raise InputError(f"{run} is not a run, so it has no worlds; leave out --world")
    if run.suffix == SUFFIX:
        return of_file(run, organisms, task, habitat)
    if task is not None:
        raise InputError(f"--task is for genome files, and {run} is not one; leave out --task")
    if of_a_task:
        return of_task(str(run), organisms, habitat)
    opened = load(run, trust).opened()
    numbers = [(each, world or 0) for each in organisms]
    if not numbers and world is not None:
        row = opened.lives.oldest(world)
        numbers = [(int(opened.lives.id[row]), world)]
    return of_run(opened, numbers, habitat)
