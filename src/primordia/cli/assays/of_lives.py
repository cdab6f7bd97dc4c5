"""Assays of organisms and genomes, which live again."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.assays.options import Found, assay, games_option, ticks_option
from primordia.cli.flags import run_argument
from primordia.cli.values import COUNT, TICKS, Finite

if TYPE_CHECKING:
    from primordia.assays.subjects import Subjects

SUFFIX = ".safetensors"
"""The suffix of a genome file."""

NUMBERED = re.compile(r"(?P<place>.+):(?P<organism>[0-9]{1,18})(@(?P<world>[0-9]{1,18}))?")
"""A run or a genome file, an organism in it, and the organism's world."""

organisms_argument = click.argument("organisms", type=int, nargs=-1, metavar="[ID]...")
world_option = click.option(
    "--world", type=int, help="The organisms' world [0 if an ID is given, otherwise see above]."
)
task_option = click.option(
    "--task", help="Task in which the genomes of a file live [the task that the file names]."
)
SUBJECTS = (run_argument, organisms_argument, world_option)
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


@assay(
    "Let two genomes compete in one world.",
    click.argument("one"),
    click.argument("other"),
    task_option,
    click.option("--worlds", type=COUNT, default=10, show_default=True, help="Number of worlds."),
    click.option(
        "--ticks", type=TICKS, default=5_000, show_default=True,
        help="Number of ticks of each world.",
    ),
    settings=True,
)  # fmt: skip
def compete(
    habitat: dict[str, Any],
    /,
    one: str,
    other: str,
    task: str | None,
    worlds: int,
    ticks: int,
    trust: bool,
) -> Found:
    """Let two genomes compete without mutation. In each world, each genome begins in half of the
    cells. Measure whose descendants take over.

    The arguments ONE and OTHER are two runs or genome files. A run stands for its champion, and a
    genome file for its first genome. `runs/a:17` is organism 17 of world 0. `runs/a:17@2` is
    organism 17 of world 2. `some.safetensors:3` is the fourth genome of a file. `Pong-survival:5`
    is a founder of a task. The worlds have the settings of the first argument, ONE. Any setting of
    the habitat can be changed by a flag.
    """
    from primordia.assays.compete import compete as measure

    sides = [_side(each, habitat, task, trust) for each in (one, other)]
    return {f"{one} and {other}": [measure(sides[0], sides[1], worlds, ticks)]}


def _side(words: str, habitat: dict[str, Any], task: str | None, trust: bool) -> "Subjects":
    """Return the subject that an argument names."""
    from primordia.api import load

    numbered = NUMBERED.fullmatch(words)
    place = Path(numbered["place"] if numbered else words)
    world = int(numbered["world"]) if numbered and numbered["world"] else None
    if numbered:
        organism = int(numbered["organism"])
    elif place.suffix == SUFFIX:
        organism = 0
    else:
        champion = load(place, trust).oldest()
        organism, world = champion.id, champion.world
    of_task = task if place.suffix == SUFFIX else None
    return subjects_of(habitat, place, (organism,), world, of_task, trust)
