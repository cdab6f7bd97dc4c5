"""The assay of two genomes in one world."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.assays.of_lives import SUFFIX, subjects_of, task_option
from primordia.cli.assays.options import Found, assay
from primordia.cli.numbers import COUNT, TICKS

if TYPE_CHECKING:
    from primordia.assays.subjects import Subjects

NUMBERED = re.compile(r"(?P<place>.+):(?P<organism>[0-9]{1,18})(@(?P<world>[0-9]{1,18}))?")
"""A run or a genome file, an organism in it, and the organism's world."""


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
