"""The commands `primordia assay ...`, which measure what is inherited and what limits evolution."""

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.flags import runs_argument

if TYPE_CHECKING:
    from primordia.api import Run

AFTER = click.option(
    "--after",
    type=click.FloatRange(0, 1, max_open=True),
    default=0.5,
    show_default=True,
    help="Share of a world's births after which a child counts.",
)
JSON = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")


@click.group()
def assay() -> None:
    """Measure what is inherited in a run, and what limits its evolution."""


@assay.command(short_help="Parents and offspring; the two terms of the Price equation.")
@runs_argument
@AFTER
@JSON
def heredity(runs: tuple[Path, ...], after: float, as_json: bool) -> None:
    """Measure how length of life is inherited, from the records.

    Several runs are one arm; of an experiment each arm is one.
    """
    _each(runs, as_json, lambda run: run.heredity(after), _heredity_table)


@assay.command(short_help="Does a good line keep its ground against its mutants?")
@runs_argument
@AFTER
@JSON
def threshold(runs: tuple[Path, ...], after: float, as_json: bool) -> None:
    """Measure the error threshold s (1 - p (1 - v)), from the records.

    P is the share of children that mutate, v the share of good parents' mutants that are as good, s how
    much longer copies of good parents live than all organisms. Above 1 a good line keeps its ground.
    Several runs are one arm; of an experiment each arm is one.
    """
    _each(runs, as_json, lambda run: run.threshold(after), _threshold_table)


def _each(
    paths: tuple[Path, ...],
    as_json: bool,
    measure: "Callable[[Run], list[Any]]",
    table: Callable[[list[Any]], list[tuple[str, ...]]],
) -> None:
    """Measure each arm, and print a table for it or one JSON object for all."""
    from primordia.api import Experiment, load

    loaded = load(paths)
    arms = list(loaded.arms.values()) if isinstance(loaded, Experiment) else [loaded]
    found = {str(arm.path): measure(arm) for arm in arms}
    if as_json:
        click.echo(
            json.dumps({name: [each.to_dict() for each in of] for name, of in found.items()})
        )
        return
    for name, of in found.items():
        _print(f"{name}: {len(of)} world{'s' * (len(of) > 1)}, medians (quartiles)", table(of))


def _heredity_table(found: list[Any]) -> list[tuple[str, ...]]:
    kinds = ("copies", "mutants", "both")
    words = {
        "slope": "slope",
        "as_long": "exactly as long",
        "longer": "a tenth longer",
        "shorter": "a third shorter",
    }
    counts = (f"{sum(getattr(each, kind).pairs for each in found):,}" for kind in kinds)
    rows = [
        (text, *(_spread(getattr(getattr(each, kind), name) for each in found) for kind in kinds))
        for name, text in words.items()
    ]
    terms = [
        (name, "", "", _spread(getattr(each, name) for each in found))
        for name in ("selection", "transmission")
    ]
    return [("", *kinds), ("pairs", *counts), *rows, *terms]


def _threshold_table(found: list[Any]) -> list[tuple[str, ...]]:
    held = [each.held for each in found if each.held is not None]
    words = {
        "mutated": "p, children that mutate",
        "as_good": "v, mutants of good parents that are as good",
        "advantage": "s, life of good parents' copies over all",
        "held": "s (1 - p (1 - v))",
    }
    rows = [(text, _spread(getattr(each, name) for each in found)) for name, text in words.items()]
    above = f"{sum(value > 1 for value in held)} of {len(held)}"
    return [("", "median"), *rows, ("worlds above 1, where a good line keeps its ground", above)]


def _spread(values: Iterable[float | None]) -> str:
    from primordia.comparison.tables import spread_text

    return spread_text(float("nan") if value is None else value for value in values)


def _print(title: str, rows: list[tuple[str, ...]]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table

    shown = Table(rows[0][0], box=box.SIMPLE_HEAD, pad_edge=False)
    for name in rows[0][1:]:
        shown.add_column(name, justify="right")
    for row in rows[1:]:
        shown.add_row(*row)
    Console(highlight=False, soft_wrap=True).print(title, shown, sep="\n")


COMMANDS = (assay,)
"""The commands of this module."""
