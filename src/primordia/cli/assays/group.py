"""The group `primordia assay`."""

import click

from primordia.cli.assays import of_islands, of_lives, of_pairs, of_records, of_runs


@click.group()
def assay() -> None:
    """Measure heredity, mutations, and what a genome is worth."""


for command in (
    of_records.heredity,
    of_records.threshold,
    of_lives.effects,
    of_runs.garden,
    of_runs.line,
    of_lives.ablate,
    of_pairs.compete,
    of_islands.transplant,
    of_islands.generalists,
):
    assay.add_command(command)
