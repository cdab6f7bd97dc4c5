"""The commands `primordia bundle` and `unbundle`: a run in one file."""

from pathlib import Path

import click

from primordia.cli.flags import run_argument
from primordia.cli.paths import OutputPath, PathType


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
