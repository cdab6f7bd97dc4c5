"""Commands that look at run directories and leave them as they are."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from primordia.cli.flags import device_option, run_argument
from primordia.errors import Trouble

if TYPE_CHECKING:
    from primordia.organism.organism import Organism


@click.command()
@run_argument
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def info(run: Path, as_json: bool) -> None:
    """What happened in a run so far."""
    from primordia.api import Run
    from primordia.history.summary import summary

    found = Run(run).info()
    click.echo(json.dumps(found) if as_json else summary(found))


@click.command(short_help="Draw figures of a run.")
@run_argument
@click.option("--out", type=click.Path(path_type=Path), help="Folder for them [RUN/figures].")
@click.option("--world", default=0, help="Whose lines of descent are drawn [0].")
@click.option(
    "--figure",
    "figures",
    multiple=True,
    metavar="NAME|module:function",
    help="Draw this one alone; may be repeated [all of ours].",
)
def plot(run: Path, out: Path | None, world: int, figures: tuple[str, ...]) -> None:
    """Draw figures: ages, survival, population, and lines of descent in space and time."""
    from primordia.api import Run

    for path in Run(run).plot(out, world, figures):
        click.echo(path)


@click.command(short_help="A life on video.")
@run_argument
@click.option("--organism", type=int, help="Birth number [who lived longest].")
@click.option(
    "--world", type=int, help="Where it lived [0, or of all where somebody lived longest]."
)
@click.option("--from", "begin", type=int, help="First age shown, in ticks.")
@click.option("--to", "end", type=int, help="Last age shown.")
@click.option(
    "--out", type=click.Path(path_type=Path), help="An .mp4 or .gif file [under RUN/videos]."
)
def replay(
    run: Path, begin: int | None, end: int | None, out: Path | None, **chosen: int | None
) -> None:
    """A life on video: all of it, or the first and last 30 seconds of a long one."""
    click.echo(who(run, **chosen).replay(out, (begin, end)))


@click.command(short_help="Write genomes to a file, to start from.")
@run_argument
@click.option(
    "--organism", "organisms", type=int, multiple=True, help="Birth number; may be repeated."
)
@click.option("--world", type=int, default=0, help="Where they lived [0].")
@click.argument("file", type=click.Path(path_type=Path))
def export(run: Path, organisms: tuple[int, ...], world: int, file: Path) -> None:
    """Write genomes to a safetensors FILE, which `primordia run --ancestor` takes.

    Without --organism that of the longest life.
    """
    from primordia.api import Run

    chosen = Run(run).export(file, *organisms, world=world)
    click.echo(f"{file}: organism {', '.join(map(str, chosen))}")


def who(run: Path, organism: int | None, world: int | None) -> "Organism":
    """The organism asked for."""
    from primordia.api import Run

    return Run(run).oldest(world) if organism is None else Run(run).organism(organism, world or 0)


@click.command(short_help="Live a run again, and compare.")
@run_argument
@device_option
def verify(run: Path, device: str) -> None:
    """Live a run again from its beginning and compare: every birth, death and genome."""
    from primordia.api import Run

    differences = Run(run).verify(device)
    if differences:
        raise Trouble(f"{run} does not hold: {differences[0]}")
    click.echo(f"{run} holds: lived again from its beginning, every world came out the same.")


@click.command()
def tasks() -> None:
    """The tasks that come with Primordia."""
    from primordia.settings.tables import tasks as known

    for name, values in known().items():
        click.echo(f"{name:28} {values.get('about', '')}")


@click.command(short_help="Runs of one task side by side.")
@click.argument("runs", nargs=-1, metavar="REFERENCE RUN...", type=click.Path(path_type=Path))
@click.option(
    "--births", type=click.IntRange(1), help="Count as saturated only before so many births."
)
@click.option(
    "--ticks", type=click.IntRange(1), help="Count as saturated only before so many ticks."
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path(),
    help="Folder for compare.png and compare.svg [the current one].",
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
def compare(runs: tuple[Path, ...], out: Path, as_json: bool, **horizons: int | None) -> None:
    """Runs of one task side by side: how soon worlds saturate, how long organisms live.

    Each run is held against the first. Worlds are the units, so give runs many of them (--seeds).
    """
    from primordia import api
    from primordia.cli.side_by_side import side_by_side
    from primordia.figures.comparison import save

    found = api.compare(*runs, **horizons)
    click.echo(json.dumps(found.to_dict()) if as_json else side_by_side(found))
    out.mkdir(parents=True, exist_ok=True)
    pictures = save(found, out)
    if not as_json:
        click.echo(f"Figure: {' and '.join(map(str, pictures))}")


COMMANDS = (info, plot, replay, compare, export, verify, tasks)
