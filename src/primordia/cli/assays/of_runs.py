"""Assays in which the oldest organisms of a run, or lines of descent, live again."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.assays.of_lives import GAMES, SUBJECTS
from primordia.cli.assays.options import (
    Found,
    after_option,
    arms_of,
    assay,
    each_option,
    source_argument,
)
from primordia.cli.flags import island_option


@assay(
    "Measure whether the oldest organisms are good or were lucky.",
    source_argument,
    each_option(20, "organisms of each group in each world"),
    after_option,
    island_option("All three groups are born on this island"),
    *GAMES,
    settings=True,
)
def garden(habitat: dict[str, Any], /, run: Path, trust: bool, **options: Any) -> Found:
    """Let three groups be born again: the oldest organisms, others born late, and founders.

    The oldest organisms were also lucky. New lives in fresh games show how good their genomes are.
    Each arm of an experiment is measured. Any setting of the habitat can be changed by a
    flag, such as --sticky 0.25 --noops 30.
    """
    from primordia.assays.garden import garden as measure

    return {
        str(arm.path): measure(arm.opened(), habitat=habitat, **options)
        for arm in arms_of((run,), trust)
    }


@assay(
    "Measure when a line of descent became good.",
    click.option(
        "--most", type=click.IntRange(min=2), default=200, show_default=True,
        help="At most this many genomes of the line live again.",
    ),
    island_option("Without an ID, the line leads to the champion of this island"),
    *SUBJECTS,
    *GAMES,
    settings=True,
)  # fmt: skip
def line(
    habitat: dict[str, Any],
    /,
    run: Path,
    organisms: tuple[int, ...],
    world: int | None,
    island: str | None,
    trust: bool,
    **options: Any,
) -> Found:
    """Let the ancestors of organisms live again, all in the same games.

    Without an ID the line leads to the champion of --world, or of the whole run. Any setting of
    the habitat can be changed by a flag, such as --sticky 0.25 --noops 30.
    """
    from primordia.api import load
    from primordia.assays.line import line as measure
    from primordia.errors import InputError
    from primordia.history.islands import oldest

    opened = load(run, trust).opened()
    numbers = [(each, world or 0) for each in organisms]
    if numbers and island is not None:
        raise InputError("--island and an organism's ID exclude each other; give one of them")
    if not numbers:
        row = oldest(opened, world, island=island)
        numbers = [(int(opened.lives.id[row]), int(opened.lives.world[row]))]
    return {str(run): [measure(opened, *each, habitat=habitat, **options) for each in numbers]}
