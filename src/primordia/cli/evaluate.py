"""The command `primordia evaluate`, which lets an organism play whole games."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.cache import cache_option
from primordia.cli.flags import CHAMPION, HabitatCommand, run_argument, trust_option
from primordia.errors import InputError

if TYPE_CHECKING:
    from primordia.organism.evaluation import Evaluation

SENSES = {
    "live": "",
    "frozen": ", senses frozen",
    "ignored": ", blindly repeating its actions in a game of its task",
}


@click.command(cls=HabitatCommand, short_help="Measure an organism in whole games.")
@run_argument
@click.option("--organism", type=int, help=f"Birth number [{CHAMPION}].")
@click.option("--world", type=int, help="The organism's world [0, or that of the champion].")
@click.option("--games", default=30, show_default=True, help="Number of games.")
@click.option("--ticks", default=100_000, show_default=True, help="Cut games at this length.")
@click.option("--freeze-senses", is_flag=True, help="Keep senses as they are at the start.")
@click.option(
    "--open-loop", is_flag=True, help="Repeat the actions of a game of its task, whatever happens."
)
@trust_option
@cache_option
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
@click.pass_obj
def evaluate(
    habitat: dict[str, Any],
    /,
    run: Path,
    organism: int | None,
    world: int | None,
    games: int,
    ticks: int,
    freeze_senses: bool,
    open_loop: bool,
    trust: bool,
    as_json: bool,
) -> None:
    """Let an organism play the game that its task is made of, from fresh starts, and print its results.

    The lifespan is counted by the rules of its task; score and length are those of the whole game. Any
    setting of the habitat can be changed by a flag, such as --sticky 0.25; `primordia evaluate RUN
    --help` lists them.
    """
    from primordia.cli.inspect import chosen_organism

    if freeze_senses and open_loop:
        raise InputError("--freeze-senses and --open-loop exclude each other; give one of them")
    senses: Any = "frozen" if freeze_senses else "ignored" if open_loop else "live"
    chosen = chosen_organism(run, organism, world, trust)
    result = chosen.evaluate(games=games, ticks=ticks, senses=senses, habitat=habitat)
    click.echo(json.dumps(result.to_dict()) if as_json else evaluation_text(result, habitat))


def evaluation_text(result: "Evaluation", changes: dict[str, Any]) -> str:
    """Return the results in a few lines."""
    values = result.to_dict()
    changed = "".join(f", {name} {value}" for name, value in changes.items())
    distinct = f"{_games(result.distinct, 'distinct ')}"
    if result.games == 1:
        distinct += "; nothing is drawn at random, so all are the same"
    lines = [
        f"organism {result.organism} of world {result.world}: {_games(result.games)}{changed}"
        f"{SENSES[result.senses]}",
        f"  {distinct}",
        f"  lifespan  {_quartiles(values['lifespan'])}{_cut(values['alive_when_cut'], 'alive')}",
    ]
    if "score" in values:
        lines.append(f"  score     {_quartiles(values['score'])}")
        lines.append(f"  length    {_quartiles(values['length'])}{_cut(values['cut'], 'going on')}")
    return "\n".join(lines)


def _games(count: int, kind: str = "") -> str:
    return f"1 {kind}game" if count == 1 else f"{count:,} {kind}games"


def _quartiles(spread: dict[str, float]) -> str:
    if spread["q1"] == spread["maximum"]:
        return f"{spread['median']:,.0f}"
    quartiles = f"quartiles {spread['q1']:,.0f}, {spread['q3']:,.0f}"
    return f"median {spread['median']:,.0f} ({quartiles}), maximum {spread['maximum']:,.0f}"


def _cut(count: int, state: str) -> str:
    return f"; {count:,} still {state} when cut" if count else ""


COMMANDS = (evaluate,)
