"""Assays in which the oldest organisms of a run, or lines of descent, live again."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.assays import tables
from primordia.cli.assays.of_lives import assay_of_lives, source_argument
from primordia.cli.assays.options import (
    after_option,
    arms_of,
    born_on,
    games_option,
    json_option,
    out_option,
    tell,
    ticks_option,
)
from primordia.cli.flags import HabitatCommand, island_option, trust_option
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
@island_option("All three groups are born on this island")
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
    island: str | None,
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
        str(arm.path): measure(arm.opened(), habitat=habitat, island=island, **options)
        for arm in arms_of((run,), trust)
    }
    tell("garden", found, as_json, out, born_on(island, tables.garden))


@click.option(
    "--most", type=click.IntRange(min=2), default=200, show_default=True,
    help="At most this many genomes of the line live again.",
)  # fmt: skip
@island_option("Without an ID, the line leads to the champion of this island")
@assay_of_lives("Measure when a line of descent became good.", genomes=False)
def line(
    habitat: dict[str, Any],
    /,
    run: Path,
    organisms: tuple[int, ...],
    world: int | None,
    island: str | None,
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
    from primordia.errors import InputError
    from primordia.history.islands import oldest

    opened = load(run, trust).opened()
    numbers = [(each, world or 0) for each in organisms]
    if numbers and island is not None:
        raise InputError("--island and an organism's ID exclude each other; give one of them")
    if not numbers:
        row = oldest(opened, world, island=island)
        numbers = [(int(opened.lives.id[row]), int(opened.lives.world[row]))]
    found = [measure(opened, *each, habitat=habitat, **options) for each in numbers]
    tell("line", {str(run): found}, as_json, out, tables.line)
