"""The options that assays share, and the output of their results."""

import json
from collections.abc import Callable, Mapping
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia import files
from primordia.cli.assays import tables
from primordia.cli.flags import HabitatCommand, trust_option
from primordia.cli.table import show_table
from primordia.cli.values import COUNT, TICKS, Finite, OutputPath

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from primordia.api import Run

after_option = click.option(
    "--after",
    type=Finite(0, 1, max_open=True),
    default=0.5,
    show_default=True,
    help="Leave out this share of each world's births, the earliest ones.",
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
out_option = click.option(
    "--out",
    type=OutputPath(file_okay=False),
    help="Draw a figure into this folder, as PNG and SVG.",
)
games_option = click.option(
    "--games",
    type=COUNT,
    default=5,
    show_default=True,
    help="Number of games of each genome; one is enough if nothing in the habitat is random.",
)
ticks_option = click.option(
    "--ticks",
    type=TICKS,
    default=20_000,
    show_default=True,
    help="Cut games at this number of ticks.",
)


def each_option(count: int, of: str) -> Callable:
    """Return the option --each with its default; `of` says which organisms are counted."""
    return click.option(
        "--each", type=COUNT, default=count, show_default=True, help=f"Number of {of}."
    )


Found = dict[str, list[Any]]
"""The results of each arm, by its path."""


def assay(
    short_help: str, *options: Callable, trusted: bool = True, settings: bool = False
) -> Callable[[Callable[..., Found]], click.Command]:
    """Return a decorator that makes a command of a function that measures; its results are printed.

    The function's name is that of its tables in `tables`, and of its figure in `figures.assays`. The
    title of a table names the island of the option --island.

    Args:
        short_help: what the command does, in a line.
        options: its arguments and options, beside --out, --trust and --json.
        trusted: whether it may execute a run's own code, so that it has the option --trust.
        settings: whether the settings of the habitat are flags too; the function takes them first.
    """
    kind: Any = {"cls": HabitatCommand} if settings else {}
    last = click.pass_obj if settings else lambda command: command
    common = (out_option, *([trust_option] if trusted else []), json_option, last)

    def decorated(measure: Callable[..., Found]) -> click.Command:
        @wraps(measure)
        def command(*given: Any, out: Path | None, as_json: bool, **chosen: Any) -> None:
            island = chosen.get("island")
            born = "" if island is None else f", born on {island}"
            tell(measure.__name__, measure(*given, **chosen), as_json, out, born)

        made: Any = command
        for option in reversed((click.command(short_help=short_help, **kind), *options, *common)):
            made = option(made)
        return made

    return decorated


def arms_of(paths: tuple[Path, ...], trust: bool = False) -> "list[Run]":
    """Return the arms of an experiment, or the named runs as one arm."""
    from primordia.api import Experiment, load

    loaded = load(paths, trust)
    return list(loaded.arms.values()) if isinstance(loaded, Experiment) else [loaded]


def tell(
    name: str,
    found: Mapping[str, list[Any]],
    as_json: bool,
    out: Path | None,
    born: str = "",
) -> None:
    """Print the tables of each arm, or one JSON object for all; draw figures if a folder is given.

    Args:
        name: the assay's name, which is also that of its functions in `tables` and `figures.assays`, and
            of its files.
        found: the results of each arm, by its path.
        as_json: whether JSON is printed.
        out: folder for figures; each of several arms has a folder in it, with the arm's name.
        born: what a table's title says of the island of birth.
    """
    if as_json:
        plain = {arm: [each.to_dict() for each in of] for arm, of in found.items()}
        click.echo(json.dumps(plain))
    else:
        for arm, of in found.items():
            told = getattr(tables, name)(f"{arm}{born}", of)
            for each in told if isinstance(told, list) else [told]:
                show_table(*each)
    if out is not None:
        from primordia.figures import assays

        draw = getattr(assays, name)
        for arm, of in found.items():
            folder = out if len(found) == 1 else out / Path(arm).name
            save_figure(partial(draw, of), folder, name, as_json)


def save_figure(
    draw: "Callable[[], Figure | None]", folder: Path, name: str, as_json: bool
) -> None:
    """Draw a figure into a folder, and print the names of its files, after JSON on stderr."""
    from primordia.figures import style

    files.make_folder(folder)
    with style.applied():
        if (figure := draw()) is None:
            return
        pictures = style.save(figure, folder / name)
    click.echo(f"Figure: {' and '.join(map(str, pictures))}", err=as_json)
