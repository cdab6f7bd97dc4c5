"""The command `primordia evaluate`, which lets organisms play whole games."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.assays.options import json_option
from primordia.cli.flags import (
    HabitatCommand,
    island_option,
    recorded_device_option,
    run_argument,
    trust_option,
)
from primordia.cli.table import show_table, spread
from primordia.cli.values import COUNT, TICKS
from primordia.errors import InputError
from primordia.printable import counted

if TYPE_CHECKING:
    from primordia.assays.controls import Standing
    from primordia.organism.playing.evaluation import Evaluation

SENSES = {
    "live": "",
    "frozen": ", senses frozen",
    "ignored": ", senses ignored: actions of a game in the run's own task are repeated",
}


@click.command(cls=HabitatCommand, short_help="Measure champions, or one organism, in whole games.")
@run_argument
@click.option(
    "--organism", type=int, help="Birth number of an organism; only this organism is measured."
)
@click.option(
    "--world",
    type=int,
    help="World of --organism [0]; without --organism, measure this world alone [all].",
)
@island_option("Measure only organisms that were born on this island, and founders there")
@click.option(
    "--on", metavar="NAME", help="Let all play on this island [each on the island of its birth]."
)
@click.option("--games", type=COUNT, default=30, show_default=True, help="Number of games.")
@click.option(
    "--founders",
    type=click.IntRange(1, 2**20),
    help="Choose the best of this number of founders [500]. If the run had fewer births, try as many"
    " founders as births.",
)
@click.option(
    "--ticks",
    type=TICKS,
    default=100_000,
    show_default=True,
    help="Cut games at this number of ticks.",
)
@click.option(
    "--freeze-senses",
    is_flag=True,
    help="Freeze the senses at their values from the start of each game.",
)
@click.option(
    "--open-loop",
    is_flag=True,
    help="Ignore the senses: repeat the actions of another game in the run's own task.",
)
@recorded_device_option
@trust_option
@json_option
@click.pass_obj
def evaluate(
    habitat: dict[str, Any],
    /,
    run: Path,
    organism: int | None,
    world: int | None,
    island: str | None,
    on: str | None,
    games: int,
    founders: int | None,
    ticks: int,
    freeze_senses: bool,
    open_loop: bool,
    trust: bool,
    as_json: bool,
) -> None:
    """Let organisms play whole games of their task from fresh starts, and print the results.

    The champion of each world plays: the longest-lived of the later half of the births. The
    controls are three groups: all living organisms, the longest-lived of many founders, and
    unselected founders.

    The lifespan is counted by the rules of the task; score and length are those of the whole game. Any
    setting of the habitat can be changed by a flag, such as --sticky 0.25; `primordia evaluate RUN
    --help` lists them.

    With --island, the champion is that of the island: the longest-lived of the organisms that were
    born on it, in the later half of the births of its world.
    """
    from primordia.api import load

    _refuse_pairs(freeze_senses and open_loop, organism, founders, island)
    senses: Any = "frozen" if freeze_senses else "ignored" if open_loop else "live"
    opened = load(run, trust)
    options: Any = {
        "games": games, "ticks": ticks, "senses": senses, "habitat": habitat, "on": on
    }  # fmt: skip
    if organism is not None:
        result = opened.organism(organism, world or 0).evaluate(**options)
        if as_json:
            click.echo(json.dumps(result.to_dict()))
        else:
            click.echo(evaluation_text(result, habitat, _places(None, on)))
        return
    number: Any = {} if founders is None else {"founders": founders}
    found = opened.standings(world=world, island=island, **number, **options)
    if as_json:
        click.echo(json.dumps({"rows": [each.to_dict() for each in found]}))
    else:
        title = f"{run}{_places(island, on)}: games cut at {ticks:,} ticks"
        title += f"{_changed(habitat)}{SENSES[senses]}"
        show_standings(found, title, away=on is not None)


def _refuse_pairs(
    both_senses: bool, organism: int | None, founders: int | None, island: str | None
) -> None:
    if both_senses:
        raise InputError("--freeze-senses and --open-loop exclude each other; give one of them")
    if organism is not None and founders is not None:
        raise InputError("--founders and --organism exclude each other: one organism plays alone")
    if organism is not None and island is not None:
        raise InputError("--island and --organism exclude each other: one organism plays alone")


def _places(island: str | None, on: str | None) -> str:
    born, played = ("" if each is None else each for each in (island, on))
    return (born and f", born on {born}") + (played and f", playing on {played}")


def evaluation_text(result: "Evaluation", changes: dict[str, Any], where: str = "") -> str:
    """Return the results in a few lines."""
    values = result.to_dict()
    distinct = counted(result.distinct, "distinct game")
    if result.deterministic:
        distinct += "; nothing is random, so all games are the same"
    lines = [
        f"organism {result.organism} of world {result.world}{where}: "
        f"{counted(result.games, 'game')}{_changed(changes)}"
        f"{SENSES[result.senses]}",
        f"  {distinct}",
        f"  lifespan  {_quartiles(values['lifespan'])}{_cut(values['alive_when_cut'], 'alive')}",
    ]
    if "score" in values:
        lines.append(f"  score     {_quartiles(values['score'])}")
        lines.append(f"  length    {_quartiles(values['length'])}{_cut(values['cut'], 'going on')}")
    return "\n".join(lines)


def show_standings(standings: "list[Standing]", title: str, away: bool = False) -> None:
    """Print a row for each group of organisms, and notes on how to read the rows.

    `away` says whether they play on another island than the one on which they were chosen.
    """
    from primordia.assays.controls import OUTCOMES

    outcomes = [name for name in OUTCOMES if standings[0].by_world(name)]
    rows = []
    for each in standings:
        values = each.to_dict()
        chosen = f"{each.chosen_from:,}" if each.chosen_from > 1 else "-"
        numbers = f"{values['organisms']:,}", chosen, f"{values['games']:,}"
        rows.append(
            (each.name, *numbers, *(spread(each.by_world(name).values()) for name in outcomes))
        )
    head = ("", "organisms", "chosen from", "games each", *outcomes)
    show_table(title, head, rows, _notes(standings, away))


def _notes(standings: "list[Standing]", away: bool) -> list[str]:
    """Return notes on how to read the rows."""
    worlds = standings[0].to_dict()["worlds"]
    notes = [
        "The best founder is the longest-lived of the founders that it was chosen from. Founders have"
        " not evolved in this run."
    ]
    if worlds > 1:
        notes.append("Medians over worlds (quartiles) of the median organism of each world.")
    if not away and all(each.repeats for each in standings[0].evaluations):
        notes.append(
            "All games of an organism are the same, so champions are judged by the very game by which"
            " they were chosen. Games differ if a setting makes them random, such as --sticky 0.25 in"
            " Atari games."
        )
    return notes


def _changed(habitat: dict[str, Any]) -> str:
    return "".join(f", {name} {value}" for name, value in habitat.items())


def _quartiles(spread: dict[str, float]) -> str:
    from primordia.comparison.tables import number_text

    told = {name: number_text(value) for name, value in spread.items()}
    if spread["minimum"] == spread["maximum"]:
        return told["median"]
    quartiles = f"quartiles {told['q1']}, {told['q3']}"
    return f"median {told['median']} ({quartiles}), minimum {told['minimum']}, maximum {told['maximum']}"


def _cut(count: int, state: str) -> str:
    return f"; {count:,} still {state} when cut" if count else ""
