"""Commands that write what others read: bundles, genomes, and metrics for dashboards."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.flags import run_argument, runs_argument, trust_option
from primordia.cli.streams import report
from primordia.cli.values import OutputPath, PathType


@click.command(short_help="Write a run into one file, to send to others.")
@run_argument
@click.argument("file", type=OutputPath())
def bundle(run: Path, file: Path) -> None:
    """Write the newest checkpoint of a run, and its records, into one FILE such as run.zip.

    Commands that read a RUN also read this FILE. Equal runs make equal files.
    """
    from primordia.api import load

    load(run).bundle(file)
    click.echo(f"{file}: {file.stat().st_size:,} bytes")


@click.command(short_help="Make a run from a bundle, to go on with it.")
@click.argument("file", type=PathType())
@click.argument("folder", type=OutputPath())
def unbundle(file: Path, folder: Path) -> None:
    """Make a run in FOLDER from a FILE that `primordia bundle` wrote. No code in the FILE is executed."""
    from primordia.runs import bundle

    bundle.unbundle(file, folder)
    click.echo(folder)


@click.command(short_help="Write genomes to a file for new runs, or write a brain as ONNX.")
@run_argument
@click.option(
    "--organism", "organisms", type=int, multiple=True, help="Birth number; may be repeated."
)
@click.option("--world", type=int, default=0, help="The organisms' world [0].")
@trust_option
@click.argument("file", type=OutputPath())
def export(run: Path, organisms: tuple[int, ...], world: int, trust: bool, file: Path) -> None:
    """Write genomes to a safetensors FILE, which `primordia run --ancestor` takes.

    If the name of FILE ends with .onnx, one brain is written as an ONNX model for other programs.

    Without --organism the genome is that of the champion: the longest-lived of the later half of
    the births.
    """
    from primordia.api import load

    chosen = load(run, trust).export(file, *organisms, world=world)
    click.echo(f"{file}: organism {', '.join(map(str, chosen))}")


@click.command("import", short_help="Write a state dictionary as a genome file.")
@click.argument("state", type=PathType())
@click.argument("file", type=OutputPath())
@click.option("--task", required=True, help="Task, or FILE.toml, whose brain has these weights.")
def import_(state: Path, file: Path, task: str) -> None:
    """Write weights from another program as a genome FILE, which `primordia run --ancestor` takes.

    STATE is a safetensors file with a tensor for each block of the brain. In PyTorch,
    safetensors.torch.save_file writes a state dictionary to such a file.
    """
    from primordia import config
    from primordia.brains import genomes

    chosen = config.load(task)
    layout = chosen.build_layout(chosen.build_habitat())
    genomes.write(file, layout, genomes.of_state(state, layout), {"task": chosen.task})
    click.echo(f"{file}: primordia run {task} --ancestor {file}")


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
