"""The command `primordia shadow`, which compares organisms with shadows that were never selected."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from primordia.cli.assays.options import arms_of, json_option
from primordia.cli.flags import (
    island_option,
    recorded_device_option,
    runs_argument,
    trust_option,
)
from primordia.cli.values import COUNT, TICKS
from primordia.printable import counted

if TYPE_CHECKING:
    from primordia.assays.shadow import Shadow


@click.command(short_help="Compare organisms to unselected ones of the same pedigree.")
@runs_argument
@click.option(
    "--organisms",
    type=COUNT,
    default=500,
    show_default=True,
    help="Largest number of organisms from each world.",
)
@click.option("--ticks", type=TICKS, help="Cut lives at this age [the task's saturation_ticks].")
@island_option("Only organisms that were born on this island live again")
@recorded_device_option
@trust_option
@json_option
def shadow(
    runs: tuple[Path, ...],
    organisms: int,
    ticks: int | None,
    island: str | None,
    trust: bool,
    as_json: bool,
) -> None:
    """Let organisms live again, and compare each with a shadow, whose line was never selected.

    The shadows have the same pedigree, and the same births mutate. Founders and what mutations change
    are drawn again. An organism and its shadow each live alone, with the same new random keys. Several
    runs are measured as one arm. Each arm of an experiment is measured.
    """
    found = [arm.shadow(organisms, ticks, island) for arm in arms_of(runs, trust)]
    if as_json:
        click.echo(json.dumps({"arms": [each.to_dict() for each in found]}))
    else:
        click.echo("\n\n".join(map(shadow_text, found)))


def shadow_text(found: "Shadow") -> str:
    """Return the result as text."""
    told = found.to_dict()
    longer, shorter = found.longer
    born = "" if found.island is None else f" born on {found.island}"
    head = (
        f"{found.name}: {told['organisms']:,} organisms{born}, each born again alone, from"
        f" {found.births:,} births in {counted(told['worlds'], 'world')};"
        f" {2 * told['organisms']:,} lives, {told['ticks']:,} ticks"
    )
    lines = [f"{'':12}{'mean life':>12}{f'reach {found.cut:,} ticks':>24}"]
    for line, name in (("original", "organisms"), ("shadow", "shadows")):
        reached = told[line]["reached_cut"]
        share = f"{reached:,} ({reached / told['organisms']:.1%})"
        lines.append(f"{name:12}{told[line]['mean']:>12,.1f}{share:>24}")
    within = found.ratio_interval
    bounds = f", 95 % interval {within[0]:.2f} to {within[1]:.2f}" if within else ""
    return "\n  ".join(
        [
            head,
            *lines,
            f"organisms live longer than their shadows in {counted(longer, 'world')} and shorter"
            f" in {shorter:,} (sign test, p = {found.p:.2g})",
            f"in the median world organisms live {found.ratio:.2f} times as long{bounds}",
        ]
    )
