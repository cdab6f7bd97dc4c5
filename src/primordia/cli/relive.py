"""The command `primordia relive`, which lives a life again and compares it with its record."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from primordia.cli.assays.options import json_option
from primordia.cli.flags import recorded_device_option, run_argument, trust_option
from primordia.cli.table import show_table
from primordia.cli.values import OutputPath
from primordia.errors import Trouble

if TYPE_CHECKING:
    from primordia.organism.reliving.compare import Reliving


@click.command(short_help="Live a life again and compare it with the record.")
@run_argument
@click.argument("organism", type=int, metavar="ID")
@click.option("--world", type=int, default=0, help="The organism's world [0].")
@click.option(
    "--from",
    "since",
    type=int,
    metavar="TICK",
    help="Begin at the newest checkpoint that is not later than this tick [birth].",
)
@click.option(
    "--save",
    type=OutputPath(),
    metavar="FILE",
    help="Write senses, actions, energy and food of each tick: .npz, .parquet or .csv.",
)
@click.option(
    "--video",
    type=OutputPath(),
    metavar="FILE",
    help="Also write a video (.mp4 or .gif). It shows only the first and last 30 seconds of a long life.",
)
@recorded_device_option
@trust_option
@json_option
def relive(
    run: Path,
    organism: int,
    world: int,
    since: int | None,
    save: Path | None,
    video: Path | None,
    trust: bool,
    as_json: bool,
) -> None:
    """Live the life of an organism again, tick for tick, and compare it with its record.

    The comparison covers the tick and the cause of death, the energy left, the food eaten, and the
    habitat's tallies. If the organism is still alive, its life is lived again until the newest
    checkpoint, and its memory and body are compared too. The exit status is 0 if all of them agree,
    1 if one differs or a file cannot be written, and 2 if the life cannot be lived again.

    The life is lived again from birth, or from the fork if the organism was born before the fork.
    If --from is given, the life is lived again from a checkpoint. A run keeps its two newest checkpoints,
    and a fork also its first checkpoint.
    """
    from primordia.api import load
    from primordia.organism.reliving import compare

    opened = load(run, trust).opened()
    found = compare.relive(opened, organism, world, since=since, save=save, film=video)
    if as_json:
        click.echo(json.dumps(found.to_dict()))
    else:
        _show(found)
    if not found.agrees:
        names = ", ".join(each.name for each in found.respects if not each.agrees)
        raise Trouble(
            f"organism {organism} of world {world}, lived again, differs from its record in: {names}"
        )


def _show(found: "Reliving") -> None:
    begin = {"birth": "its birth", "fork": "the fork", "checkpoint": "the checkpoint"}[found.begin]
    title = (
        f"organism {found.organism} of world {found.world}, lived again from {begin} at tick"
        f" {found.begins:,} to tick {found.ends:,}"
    )
    rows = [
        (each.name, _text(each.recorded), _text(each.relived), "yes" if each.agrees else "NO")
        for each in found.respects
    ]
    notes = [*(f"Note: {each}." for each in found.notes), *map(str, found.files)]
    show_table(title, ("", "recorded", "relived", "agrees"), rows, notes)


def _text(value: object) -> str:
    if value is None:
        return "-"
    return value if isinstance(value, str) else f"{value:,.10g}"
