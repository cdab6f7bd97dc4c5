"""Assays that only read records: no organism lives again."""

from pathlib import Path

import click

from primordia.cli.assays import tables
from primordia.cli.assays.options import (
    after_option,
    arms_of,
    born_on,
    json_option,
    out_option,
    tell,
)
from primordia.cli.flags import island_option, runs_argument


@click.command(short_help="Measure how strongly length of life is inherited.")
@runs_argument
@after_option
@island_option("Count only parents and children that were both born on this island")
@out_option
@json_option
def heredity(
    runs: tuple[Path, ...], after: float, island: str | None, out: Path | None, as_json: bool
) -> None:
    """Measure from the records how strongly length of life is inherited.

    Several runs are measured as one arm. Each arm of an experiment is measured.
    """
    found = {str(arm.path): arm.heredity(after, island) for arm in arms_of(runs)}
    tell("heredity", found, as_json, out, born_on(island, tables.heredity))


@click.command(short_help="Measure the error threshold of mutation.")
@runs_argument
@after_option
@island_option("Count only organisms, and their children, that were born on this island")
@out_option
@json_option
def threshold(
    runs: tuple[Path, ...], after: float, island: str | None, out: Path | None, as_json: bool
) -> None:
    """Measure the error threshold s (1 - p (1 - v)), from the records.

    p is the share of children that mutate. v is the share of good parents' mutants that are as good
    as the parents. s is the mean life of good parents' copies, divided by the mean life of all
    organisms. If the result is above 1, a good line persists. Several runs are measured as one arm.
    Each arm of an experiment is measured.
    """
    found = {str(arm.path): arm.threshold(after, island) for arm in arms_of(runs)}
    tell("threshold", found, as_json, out, born_on(island, tables.threshold))
