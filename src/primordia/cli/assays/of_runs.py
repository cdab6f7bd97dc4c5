"""Assays in which the oldest organisms of a run, or lines of descent, live again."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.assays import tables
from primordia.cli.assays.of_lives import assay_of_lives, source_argument
from primordia.cli.assays.options import (
    after_option,
    arms_of,
    games_option,
    json_option,
    out_option,
    tell,
    ticks_option,
)
from primordia.cli.flags import HabitatCommand, trust_option
from primordia.cli.numbers import COUNT


@click.command(
    cls=HabitatCommand, short_help="Measure whether the oldest organisms are good or were lucky."
)
@source_argument
@click.option(
    "--each", type=COUNT, default=20, show_default=True,
    help="Number of organisms of each group in each world.",
)  # fmt: skip
@after_option
@games_option
@ticks_option
@out_option
@trust_option
@json_option
@click.pass_obj
def garden(
    habitat: dict[str, Any],
    /,
    run: Path,
    trust: bool,
    out: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Let three groups be born again: the oldest organisms, others born late, and founders.

    The oldest organisms were also lucky. New lives in fresh games show how good their genomes are.
    Each arm of an experiment is measured. Any setting of the habitat can be changed by a
    flag, such as --sticky 0.25 --noops 30.
    """
    from primordia.assays.garden import garden as measure

    found = {
        str(arm.path): measure(arm.opened(), habitat=habitat, **options)
        for arm in arms_of((run,), trust)
    }
    tell("garden", found, as_json, out, tables.garden)


@click.option(
    "--most", type=click.IntRange(min=2), default=200, show_default=True,
    help="At most this many genomes of the line live again.",
)  # fmt: skip
@assay_of_lives("Measure when a line of descent became good.", genomes=False)
def line(
    habitat: dict[str, Any],
    /,
    run: Path,
    organisms: tuple[int, ...],
    world: int | None,
    trust: bool,
    out: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Let the ancestors of organisms live again, all in the same games.

    Without an ID the line leads to the champion of --world, or of the whole run. Any setting of
    the habitat can be changed by a flag, such as --sticky 0.25 --noops 30.
    """
    from primordia.api import load
    from primordia.assays.line import line as measure

    opened = load(run, trust).opened()
    numbers = [(each, world or 0) for each in organisms]
    if not numbers:
        row = opened.lives.oldest(world)
        numbers = [(int(opened.lives.id[row]), int(opened.lives.world[row]))]
    found = [measure(opened, *each, habitat=habitat, **options) for each in numbers]
    tell("line", {str(run): found}, as_json, out, tables.line)
