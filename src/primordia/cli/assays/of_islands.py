"""Assays in which organisms live again on the islands of a run."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from primordia.cli.assays import tables
from primordia.cli.assays.of_lives import source_argument
from primordia.cli.assays.options import (
    after_option,
    arms_of,
    games_option,
    json_option,
    out_option,
    tell,
    ticks_option,
)
from primordia.cli.flags import trust_option
from primordia.cli.numbers import COUNT


def assay_of_islands(short_help: str, each: int, of: str) -> Callable:
    """Return a decorator for commands whose subjects live again on every island.

    Args:
        short_help: what the command does, in a line.
        each: the default number of organisms.
        of: the words that say which organisms are counted.
    """
    options = (
        click.command(short_help=short_help),
        source_argument,
        click.option(
            "--each", type=COUNT, default=each, show_default=True, help=f"Number of {of}."
        ),
        after_option,
        games_option,
        ticks_option,
        out_option,
        trust_option,
        json_option,
    )

    def decorated(function: Any) -> Any:
        for option in reversed(options):
            function = option(function)
        return function

    return decorated


@assay_of_islands(
    "Measure how natives of each island live on every island.",
    each=20,
    of="natives of each island of a world, and number of founders",
)
def transplant(run: Path, trust: bool, out: Path | None, as_json: bool, **options: Any) -> None:
    """Let natives of each island live again on every island of their world, beside founders.

    Natives of an island were born there late. If natives live longer at home than natives of other
    islands live there, they are adapted to their home (local against foreign; Kawecki & Ebert 2004).
    Each arm of an experiment is measured.
    """
    from primordia.assays.transplant import transplant as measure

    found = {str(arm.path): measure(arm.opened(), **options) for arm in arms_of((run,), trust)}
    tell("transplant", found, as_json, out, tables.transplant)


@click.option(
    "--most", type=click.IntRange(min=2), default=40, show_default=True,
    help="At most this many ancestors of a line live again.",
)  # fmt: skip
@assay_of_islands(
    "Measure who lives long on several islands, and since when.",
    each=40,
    of="late organisms of each world, and number of founders",
)
def generalists(run: Path, trust: bool, out: Path | None, as_json: bool, **options: Any) -> None:
    """Let late organisms live again on every island, then the ancestors of the most general one.

    An organism masters an island if it lives there longer than the best of as many founders. The last
    table shows since which ancestor the line of a world's most general organism masters an island.
    Each arm of an experiment is measured.
    """
    from primordia.assays.generalists import generalists as measure

    found = {str(arm.path): measure(arm.opened(), **options) for arm in arms_of((run,), trust)}
    tell("generalists", found, as_json, out, tables.generalists)
