"""Commands that change no record of a run."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia import files
from primordia.cli.assays.options import json_option
from primordia.cli.experiment import show_status
from primordia.cli.flags import (
    island_option,
    recorded_device_option,
    run_argument,
    runs_argument,
    trust_option,
    video_option,
)
from primordia.cli.values import OutputPath
from primordia.errors import Trouble

if TYPE_CHECKING:
    from primordia.organism.organism import Organism


@click.command()
@runs_argument
@json_option
def info(runs: tuple[Path, ...], as_json: bool) -> None:
    """Summarise a run so far, an arm, or an experiment."""
    from primordia.api import Experiment, load
    from primordia.history.summary import summary

    loaded = load(runs)
    if as_json:
        click.echo(json.dumps(loaded.info()))
    elif isinstance(loaded, Experiment):
        show_status(loaded.status())
    else:
        click.echo(summary(loaded.info()))


@click.command(short_help="Draw figures of a run.")
@runs_argument
@click.option("--out", type=OutputPath(), help="Folder for the figures [RUN/figures].")
@click.option("--world", default=0, help="World whose lines of descent are drawn [0].")
@click.option(
    "--figure",
    "figures",
    multiple=True,
    metavar="NAME|module:function",
    help="Draw only this figure; may be repeated [all figures].",
)
def plot(runs: tuple[Path, ...], out: Path | None, world: int, figures: tuple[str, ...]) -> None:
    """Draw figures: ages, survival, population, and lines of descent in space and time.

    Several runs are drawn as one arm. The arms of an experiment are also drawn side by side.
    """
    from primordia.api import load

    for path in load(runs).plot(out, world, figures):
        click.echo(path)


@click.command(short_help="Make a video of a life.")
@run_argument
@click.option("--organism", type=int, help="Birth number of the organism [the champion].")
@click.option(
    "--world", type=int, help="World of the organism [0 with --organism, otherwise the champion's]."
)
@click.option(
    "--beside",
    multiple=True,
    metavar="ID|RUN",
    help="Show this life too, or that of another run's champion; may be repeated.",
)
@click.option("--from", "begin", type=int, help="First age shown, in ticks.")
@click.option("--to", "end", type=int, help="Last age shown, in ticks.")
@video_option
@recorded_device_option
@trust_option
def replay(
    run: Path,
    beside: tuple[str, ...],
    begin: int | None,
    end: int | None,
    out: Path | None,
    **chosen: Any,
) -> None:
    """Make a video of a life: the whole life, or the first and last 30 seconds of a long life.

    Without --organism the life is that of the champion: the longest-lived of the later half of the
    births.
    With --beside, lives are shown side by side, each from birth: organisms of the same world in order of
    birth, then the champions of other runs.
    A life that has ended stays at the last picture.
    If brains learn or the world changes within lives, a panel shows fast weights, outputs and changes.
    """
    one, trust = chosen_organism(run, **chosen), chosen["trust"]
    others = [
        int(each) if each.isdecimal() else chosen_organism(Path(each), None, None, trust)
        for each in beside
    ]
    click.echo(one.replay(out, (begin, end), others))


@click.command(short_help="Make a film of a world.")
@run_argument
@video_option
@click.option("--world", default=0, help="The world's number [0].")
@click.option(
    "--by",
    type=click.Choice(["births", "ticks"]),
    default="births",
    help="Equally many births, or ticks, pass from each picture to the next [births].",
)
@click.option("--from", "begin", type=int, metavar="TICK", help="First tick shown.")
@click.option("--to", "end", type=int, metavar="TICK", help="Last tick shown.")
@click.option(
    "--organism",
    type=int,
    metavar="ID",
    help="Organism whose life is shown [the longest-lived so far].",
)
@recorded_device_option
@trust_option
def film(run: Path, trust: bool, begin: int | None, end: int | None, **chosen: Any) -> None:
    """Film a world: births and deaths in all its cells, and beside them one organism's life.

    The colour of a cell shows the line of descent. Cells are lighter with age, flash at a birth, and
    fade after a death. A torus is drawn as a square. A ring is drawn as a disc, with the present at
    the edge and the past inside. The film shows the world for at most half a minute, and then the
    last picture for two more seconds. The life beside the world is shown at a different speed.
    """
    from primordia.api import load

    click.echo(load(run, trust).film(ticks=(begin, end), **chosen))


def chosen_organism(run: Path, organism: int | None, world: int | None, trust: bool) -> "Organism":
    """Return the organism with a birth number, or else the champion."""
    from primordia.api import load

    opened = load(run, trust)
    return opened.oldest(world) if organism is None else opened.organism(organism, world or 0)


@click.command(short_help="Repeat a run and compare.")
@run_argument
@recorded_device_option
@trust_option
def verify(run: Path, trust: bool) -> None:
    """Repeat a run from its beginning and compare every birth, death and genome with its records."""
    from primordia.api import load

    differences = load(run, trust).verify()
    if differences:
        raise Trouble(f"{run} differs from its records when repeated: {differences[0]}")
    click.echo(
        f"{run} is verified: every world was repeated from its beginning with the same result."
    )


@click.command()
def tasks() -> None:
    """List the tasks that come with Primordia."""
    from primordia.settings.tables import tasks as known

    for name, values in known().items():
        click.echo(f"{name:28} {values.get('about', '')}")


@click.command(short_help="Compare runs of one task.")
@click.argument("runs", nargs=-1, metavar="REFERENCE RUN...")
@click.option(
    "--births", type=click.IntRange(1), help="Horizon in births: a later saturation does not count."
)
@click.option(
    "--ticks", type=click.IntRange(1), help="Horizon in ticks: a later saturation does not count."
)
@island_option("Count only organisms that were born on this island")
@click.option(
    "--out",
    type=OutputPath(file_okay=False),
    default=Path(),
    help="Folder for compare.png and compare.svg [the current folder].",
)
@json_option
def compare(runs: tuple[str, ...], out: Path, as_json: bool, **options: Any) -> None:
    """Compare runs of one task: how soon worlds saturate, how long organisms live.

    All other runs are compared with the first run. The sample size is the number of worlds. So each
    run needs many worlds (--seeds), or several runs must be joined in an arm: 'heredity=runs/h*'
    'none=runs/n*'.

    With --island, saturation, extinctions and food are left out, since they are counted for whole
    worlds.
    """
    from primordia import api
    from primordia.comparison.tables import comparison_tables
    from primordia.figures.comparison import save

    compared = api.compare(*runs, **options)
    click.echo(json.dumps(compared.to_dict()) if as_json else comparison_tables(compared))
    files.make_folder(out)
    pictures = save(compared, out)
    if not as_json:
        click.echo(f"Figure: {' and '.join(map(str, pictures))}")
