"""Assays that read records, and let nothing live."""

from pathlib import Path

import click

from primordia.cli.assays import tables
from primordia.cli.assays.options import after_option, arms_of, json_option, out_option, tell
from primordia.cli.flags import runs_argument


@click.command(short_help="Parents and offspring; the two terms of the Price equation.")
@runs_argument
@after_option
@out_option
@json_option
def heredity(runs: tuple[Path, ...], after: float, out: Path | None, as_json: bool) -> None:
    """Measure how length of life is inherited, from the records.

    Several runs are one arm; of an experiment each arm is one.
    """
    found = {str(arm.path): arm.heredity(after) for arm in arms_of(runs)}
    tell("heredity", found, as_json, out, tables.heredity)


@click.command(short_help="Does a good line keep its ground against its mutants?")
@runs_argument
@after_option
@out_option
@json_option
def threshold(runs: tuple[Path, ...], after: float, out: Path | None, as_json: bool) -> None:
    """Measure the error threshold s (1 - p (1 - v)), from the records.

    P is the share of children that mutate, v the share of good parents' mutants that are as good, s how
    much longer copies of good parents live than all organisms. Above 1 a good line keeps its ground.
    Several runs are one arm; of an experiment each arm is one.
    """
    found = {str(arm.path): arm.threshold(after) for arm in arms_of(runs)}
    tell("threshold", found, as_json, out, tables.threshold)
