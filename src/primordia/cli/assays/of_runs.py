"""Assays of runs: from their records alone, or with organisms that live again."""

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
)
from primordia.cli.flags import island_option, run_argument, runs_argument


@assay(
    "Measure how strongly length of life is inherited.",
    runs_argument,
    after_option,
    island_option("Count only parents and children that were both born on this island"),
    trusted=False,
)
def heredity(runs: tuple[Path, ...], after: float, island: str | None) -> Found:
    """Measure from the records how strongly length of life is inherited.

    Several runs are measured as one arm. Each arm of an experiment is measured.
    """
    return {str(arm.path): arm.heredity(after, island) for arm in arms_of(runs)}


@assay(
    "Measure the error threshold of mutation.",
    runs_argument,
    after_option,
    island_option("Count only organisms, and their children, that were born on this island"),
    trusted=False,
)
def threshold(runs: tuple[Path, ...], after: float, island: str | None) -> Found:
    """Measure the error threshold s (1 - p (1 - v)), from the records.

    p is the share of children that mutate. v is the share of good parents' mutants that are as good
    as the parents. s is the mean life of good parents' copies, divided by the mean life of all
    organisms. If the result is above 1, a good line persists. Several runs are measured as one arm.
    Each arm of an experiment is measured.
    """
    return {str(arm.path): arm.threshold(after, island) for arm in arms_of(runs)}


@assay(
    "Measure whether the oldest organisms are good or were lucky.",
    run_argument,
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


@assay(
    "Measure how natives of each island live on every island.",
    run_argument,
    each_option(20, "natives of each island of a world, and number of founders"),
    after_option,
    *GAMES,
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
    run_argument,
    each_option(40, "late organisms of each world, and number of founders"),
    after_option,
    *GAMES,
)  # fmt: skip
def generalists(run: Path, trust: bool, **options: Any) -> Found:
    """Let late organisms live again on every island, then the ancestors of the most general one.

    An organism masters an island if it lives there longer than the best of as many founders. The last
    table shows since which ancestor the line of a world's most general organism masters an island.
    Each arm of an experiment is measured.
    """
    from primordia.assays.generalists import generalists as measure

    return {str(arm.path): measure(arm.opened(), **options) for arm in arms_of((run,), trust)}
