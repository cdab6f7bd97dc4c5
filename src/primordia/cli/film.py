"""The command `primordia film`, which films a world."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.flags import recorded_device_option, run_argument, trust_option, video_option


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
