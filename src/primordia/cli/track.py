"""The command `primordia track`: metrics for dashboards."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.flags import runs_argument
from primordia.cli.paths import OutputPath
from primordia.cli.streams import report


@click.command(short_help="Write metrics for TensorBoard or W&B.")
@runs_argument
@click.option("--tensorboard", type=OutputPath(), metavar="DIR", help="Folder for TensorBoard.")
@click.option(
    "--wandb",
    type=OutputPath(),
    metavar="DIR",
    help="Folder for Weights & Biases, in its offline format.",
)
@click.option(
    "--follow", is_flag=True, help="Go on until all runs have stopped or you press Ctrl-C."
)
@click.option(
    "--every",
    type=float,
    default=30.0,
    show_default=True,
    metavar="SECONDS",
    help="With --follow: the interval between two readings.",
)
def track(
    runs: tuple[Path, ...], tensorboard: Path | None, wandb: Path | None, **options: Any
) -> None:
    """Write, for dashboards, the metrics of a run, of several runs as one arm, or of an experiment.

    Each column of the table `metrics` becomes a series over ticks. Each world becomes a run of the
    dashboard, such as seed-3. The command reads the newest checkpoint and does not disturb the RUN.
    The output of an earlier call for the same worlds is replaced.
    """
    from primordia.api import load

    shown: list[int] = []

    def say(rows: int) -> None:
        if rows and not shown:
            shown.append(rows)
            for line in _how_to_look(tensorboard, wandb):
                click.echo(line)

    try:
        load(runs).track(tensorboard, wandb, seen=say, **options)
    except KeyboardInterrupt:
        report("stopped; everything read so far is written")
        raise click.Abort from None


def _how_to_look(tensorboard: Path | None, wandb: Path | None) -> list[str]:
    ways = {
        "tensorboard --logdir {}": tensorboard,
        "wandb sync {}/wandb/offline-run-*": wandb,
    }
    return [
        f"Look at the metrics with: {way.format(folder)}" for way, folder in ways.items() if folder
    ]
