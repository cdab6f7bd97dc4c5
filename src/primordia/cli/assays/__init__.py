"""The commands `primordia assay ...`: heredity, limits of evolution, and the worth of genomes."""

import click

from primordia.cli.assays import of_lives, of_runs


@click.group()
def assay() -> None:
    """Measure heredity, mutations, and what a genome is worth."""


for command in (
    of_runs.heredity,
    of_runs.threshold,
    of_lives.effects,
    of_runs.garden,
    of_runs.line,
    of_lives.ablate,
    of_lives.compete,
    of_runs.transplant,
    of_runs.generalists,
):
    assay.add_command(command)
