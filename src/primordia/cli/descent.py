"""Commands on descent: ancestors, lineages, phylogeny."""

import json
from functools import partial
from math import isnan
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.assays.options import json_option, out_option, save_figure
from primordia.cli.flags import run_argument, trust_option
from primordia.cli.streams import report
from primordia.cli.table import show_table
from primordia.cli.values import OutputPath
from primordia.errors import InputError

if TYPE_CHECKING:
    from primordia.phylogeny.descent import Ancestors
    from primordia.phylogeny.lines import WorldLines
    from primordia.phylogeny.sweeps import Sweep

ROWS, LINES = 20, 10
"""Largest numbers of rows: of the table of ancestors, and of the table of lines of descent."""


@click.command(short_help="Show the line of descent of an organism.")
@run_argument
@click.argument("organism", type=int, required=False, metavar="[ID]")
@click.option(
    "--world", type=int, help="World of the organism [0 if ID is given, otherwise the champion's]."
)
@out_option
@trust_option
@json_option
def ancestors(
    run: Path, organism: int | None, world: int | None, out: Path | None, trust: bool, as_json: bool
) -> None:
    """Show the ancestors of the organism with birth number ID, and how far each one's descendants spread.

    Without ID the organism is the champion: the longest-lived of the later half of the births. The
    table shows some of the ancestors; --json shows all of them. If bodies are inherited, --out also draws
    portraits of some ancestors.
    """
    from primordia.api import load

    loaded = load(run, trust)
    found = loaded.ancestors(organism, world, report)
    if as_json:
        click.echo(json.dumps(found.to_dict()))
    else:
        _show_ancestors(run, found)
    if out is not None:
        from primordia.figures import descent, portraits

        save_figure(partial(descent.draw, found), out, "ancestors", as_json)
        save_figure(partial(portraits.draw, loaded.opened(), found), out, "portraits", as_json)


@click.command(short_help="Measure lines of descent: selection and drift, sweeps, diversity.")
@run_argument
@click.option("--world", default="0", metavar="N|all", help="Number of a world, or all [0].")
@click.option(
    "--at", type=int, metavar="TICK", help="Tick at which the lines are founded [see above]."
)
@out_option
@json_option
def lineages(run: Path, world: str, at: int | None, out: Path | None, as_json: bool) -> None:
    """Measure how lines of descent replace each other, and compare them with neutral shadows.

    A line consists of an organism that is alive after a certain tick (--at), and of all its
    descendants. By default, this tick is the first that ends with 16 or more living organisms. If
    the population never reaches 32, half of its largest size is enough. Ticks before the last
    extinction do not count. If founders fill the world, the default is their tick of birth.
    """
    from primordia.api import load

    found = load(run).lineages(_world(world), at)
    if as_json:
        click.echo(json.dumps([each.to_dict() for each in found]))
    else:
        for each in found:
            _show_lines(run, each)
    if out is not None:
        from primordia.figures import lines as figure

        for each in found:
            save_figure(partial(figure.draw, each), out, f"lines-{each.world}", as_json)


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


def _world(text: str) -> int | None:
    if text == "all":
        return None
    try:
        return int(text)
    except ValueError:
        raise InputError(f"--world: {text!r} is neither the number of a world nor `all`") from None


def _show_ancestors(run: Path, found: "Ancestors") -> None:
    places = found.telling(ROWS).tolist()
    show_table(
        f"{run}: the line of organism {found.organism:,} of world {found.world}",
        (
            "organism",
            "line",
            "born",
            *(() if found.islands is None else ("island", "migrations")),
            *(found.traits or ()),
            "lived",
            "death",
            "children",
            "change",
            "10 %",
            "50 %",
            "all",
        ),
        [_ancestor_row(found, place) for place in places],
        [*_ancestor_notes(found, len(found.line) - len(places)), _common_text(found)],
    )


def _ancestor_notes(found: "Ancestors", left_out: int) -> list[str]:
    """Return what the columns mean, and what is missing."""
    notes = [
        "change: L2 norm of the change that mutation made to the genome.",
        "10 %, 50 %, all: first tick after which more than 10 %, more than 50 %, or all of the living"
        " descended from the ancestor.",
    ]
    if left_out:
        notes.append(
            f"{left_out:,} ancestors are left out. The table shows the first, the last, those that"
            " outlived their parents most, and others evenly spaced. --json shows all."
        )
    if found.unknown:
        which = "The changes" if found.changes is None else "The changes before a fork"
        notes.append(f"{which} are unknown: {found.unknown}.")
    first = found.step(0)
    if first["birth_cause"] == "founder" and first["parent"] is not None:
        notes.append(
            "Genomes are not inherited, so the line is this organism alone. 10 %, 50 %, all and the"
            " common ancestor follow who was born of whom."
        )
    if found.islands is not None:
        notes.append("migrations: births up to this organism on another island than the parent's.")
    if found.traits:
        notes.append(f"{', '.join(found.traits)}: factors of the habitat's own parameters.")
    return notes


def _ancestor_row(found: "Ancestors", place: int) -> tuple[str, ...]:
    step = found.step(place)
    size = None if found.size is None else found.size[place]
    return (
        f"{step['organism']:,}",
        *(f"{step[name]:,}" for name in ("generation", "born")),
        *((step["island"], f"{step['migrations']:,}") if "island" in step else ()),
        *(_number(factor, ".2f") for factor in step.get("traits", {}).values()),
        f"{step['lifespan']:,}",
        step["cause"] or "alive",
        f"{step['children']:,}",
        _number(size, ".3g") if step["birth_cause"] == "mutant" else step["birth_cause"],
        *(_number(step[name], ",") for name in ("tenth", "half", "fixed")),
    )


def _common_text(found: "Ancestors") -> str:
    if (common := found.common) is not None:
        return (
            f"The common ancestor of the living is organism {common.organism:,}, born at tick"
            f" {common.born:,} in generation {common.generation:,}. Since tick"
            f" {common.since:,} all of the living descend from this organism."
        )
    if not found.roots:
        return "Nothing is alive, so there is no common ancestor of the living."
    return (
        f"The living have no common ancestor on record. They descend from {found.roots:,} organisms"
        " without a parent on record."
    )


def _show_lines(run: Path, found: "WorldLines") -> None:
    told = found.to_dict()
    rows = [
        (
            f"{line['organism']:,}",
            *((line["island"], f"{line['migrations']:,}") if "island" in line else ()),
            f"{line['largest_share']:.3f}",
            f"{line['final_share']:.3f}",
            _number(line["slope"], ".2g"),
            _number(line["slope_per_lifespan"], ".2g"),
            _number(line["p_of_slope"], ".2g"),
            _number(line["p_of_final_share"], ".2g"),
        )
        for line in told["lines"][:LINES]
    ]
    homes = () if found.islands is None else ("island", "migrations")
    head = (
        "line of",
        *homes,
        "largest",
        "last share",
        "s per tick",
        "s per life",
        "p of s",
        "p of last",
    )
    title = (
        f"{run}: world {found.world}, {len(found.founders):,} lines founded at tick "
        f"{told['founded']:,},"
        f" up to tick {found.ticks[-1]:,}"
    )
    show_table(title, head, rows, _notes(found, told))


def _notes(found: "WorldLines", told: dict[str, Any]) -> list[str]:
    notes = []
    if (left_out := len(found.founders) - LINES) > 0:
        notes.append(f"{left_out:,} smaller lines are left out; --json shows all.")
    if found.islands is not None:
        notes.append(
            "island: where the first organism of the line was born. migrations: births in the line on"
            " another island than the parent's."
        )
    now, (low, high) = found.effective[2, -1], (e[-1] for e in told["bands"]["effective_lines"])
    notes += [
        "s: slope of ln(x / (1 - x)) over time while the share x is between 5 and 95 %. p: two-sided"
        " p-value from neutral shadows with the same births, deaths and population.",
        f"Effective number of lines at the end: {now:.2f}; in 95 % of {told['shadows']:,} shadows"
        f" {low:.2f} to {high:.2f}. For its mean over time: p = {told['p_of_effective_lines']:.2g}.",
        _sweeps_text(found.sweeps),
        f"Phylogenetic diversity of the living: {found.diversity[-1]:,} ticks.",
    ]
    if found.pairs.mean is not None and found.neutral_pairs.mean is not None:
        notes.append(
            f"{found.pairs.share[-1]:.0%} of the pairs of the living have a common ancestor on"
            f" record, {found.pairs.mean:,.0f} ticks ago on average. With drift alone,"
            f" {found.neutral_pairs.share[-1]:.0%} would have one,"
            f" {found.neutral_pairs.mean:,.0f} ticks ago."
        )
    return notes


def _sweeps_text(sweeps: "list[Sweep]") -> str:
    durations = [each.duration for each in sweeps if each.duration is not None]
    text = f"Sweeps to all of the living: {len(durations):,}"
    if durations:
        text += f"; median duration: {median(durations):,.10g} ticks"
    if sweeps and sweeps[-1].half is not None and sweeps[-1].fixed is None:
        last = sweeps[-1]
        text += (
            f". Under way: the sweep of organism {last.organism:,}, whose descendants have been more than"
            f" half of the living since tick {last.half:,}"
        )
    return f"{text}."


def _number(value: float | None, form: str) -> str:
    return "-" if value is None or isnan(value) else f"{value:{form}}"
