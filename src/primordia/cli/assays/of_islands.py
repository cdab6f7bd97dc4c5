"""Assays in which organisms live again on the islands of a run."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.assays.options import (
    Found,
    after_option,
    arms_of,
    assay,
    each_option,
    games_option,
    source_argument,
    ticks_option,
)

COMMON = (after_option, games_option, ticks_option)


@assay(
    "Measure how natives of each island live on every island.",
    source_argument,
    each_option(20, "natives of each island of a world, and number of founders"),
    *COMMON,
)
def transplant(run: Path, trust: bool, **options: Any) -> Found:
    """Let natives of each island live again on every island of their world, beside founders.

    Natives of an island were born there late. If natives live longer at home than natives of other
    islands live there, they are adapted to their home (local against foreign; Kawecki & Ebert 2004).
    Each arm of an experiment is measured.
    """
    from primordia.assays.transplant import transplant as measure

    return {str(arm.path): measure(arm.opened(), **options) for arm in arms_of((run,), trust)}


@assay(
    "Measure who lives long on several islands, and since when.",
    click.option(
        "--most", type=click.IntRange(min=2), default=40, show_default=True,
        help="At most this many ancestors of a line live again.",
    ),
    source_argument,
    each_option(40, "late organisms of each world, and number of founders"),
    *COMMON,
)  # fmt: skip
def generalists(run: Path, trust: bool, **options: Any) -> Found:
    """Let late organisms live again on every island, then the ancestors of the most general one.

    An organism masters an island if it lives there longer than the best of as many founders. The last
    table shows since which ancestor the line of a world's most general organism masters an island.
    Each arm of an experiment is measured.
    """
    from primordia.assays.generalists import generalists as measure

    return {str(arm.path): measure(arm.opened(), **options) for arm in arms_of((run,), trust)}
