"""The command `primordia phylogeny`: the phylogeny of a run for other programs."""

from pathlib import Path
from typing import Any

import click

from primordia.cli.flags import run_argument, trust_option
from primordia.cli.paths import OutputPath
from primordia.cli.streams import report


@click.command(short_help="Write the phylogeny of a run for other programs.")
@run_argument
@click.argument("organism", type=int, required=False, metavar="[ID]")
@click.option(
    "--out",
    type=OutputPath(),
    required=True,
    metavar="FILE",
    help="File to write: .parquet, .csv, .nwk or .tsv.",
)
@click.option("--world", type=int, help="Write only this world [0 if ID is given, otherwise all].")
@click.option("--extant", is_flag=True, help="Write only the living and their ancestors.")
@click.option(
    "--collapse", is_flag=True, help="Leave out the dead that have a parent and only one child."
)
@click.option("--traits", is_flag=True, help="Add the traits of bodies; genomes are made again.")
@trust_option
def phylogeny(run: Path, organism: int | None, out: Path, trust: bool, **choice: Any) -> None:
    """Write the parent, the life and the death of each organism to a file for other programs.

    With ID, a birth number, only that organism and its ancestors are written. Organisms that lived before
    a fork are read from the run that was forked.

    The suffix of FILE gives the format. .parquet and .csv are tables in the ALife data standard.
    .nwk and .newick are trees in Newick. .tsv holds metadata of the tree for Taxonium.
    """
    from primordia.api import load

    load(run, trust).phylogeny(organism, out=out, say=report, **choice)
    click.echo(out)
