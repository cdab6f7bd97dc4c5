"""`primordia evaluate`: an organism plays whole games."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from primordia.cli.flags import HabitatCommand, run_argument
from primordia.errors import InputError

if TYPE_CHECKING:
    from primordia.organism.evaluation import Evaluation

SENSES = {
    "live": "",
    "frozen": ", senses frozen",
    "ignored": ", blindly doing what it did in a game of its task",
}


@click.command(cls=HabitatCommand, short_help="How an organism does in whole games.")
@run_argument
@click.option("--organism", type=int, help="Birth number [who lived longest].")
@click.option("--world", type=int, help="Where it lived [0, or where somebody lived longest].")
@click.option("--episodes", default=30, show_default=True, help="Games.")
@click.option("--ticks", default=100_000, show_default=True, help="Cut games that go on then.")
@click.option("--freeze-senses", is_flag=True, help="Senses stay as they are at the start.")
@click.option(
    "--open-loop", is_flag=True, help="It does what it did in a game of its task, whatever happens."
)
@click.option("--json", "as_json", is_flag=True, help="One JSON object.")
@click.pass_obj
def evaluate(
    habitat: dict[str, Any],
    /,
    run: Path,
    organism: int | None,
    world: int | None,
    episodes: int,
    ticks: int,
    freeze_senses: bool,
    open_loop: bool,
    as_json: bool,
) -> None:
    """Let an organism play the game its task is made of, from fresh starts, and say how it does.

    A lifespan is what its task makes of a game; score and length are those of the whole game. Any
    setting of the habitat can be changed by a flag, such as --sticky 0.25; `primordia evaluate RUN
    --help` lists them.
    """
    from primordia.cli.look import who

    if freeze_senses and open_loop:
        raise InputError("--freeze-senses and --open-loop: one or the other")
    senses: Any = "frozen" if freeze_senses else "ignored" if open_loop else "live"
    chosen = who(run, organism, world)
    found = chosen.evaluate(games=episodes, ticks=ticks, senses=senses, habitat=habitat)
    click.echo(json.dumps(found.to_dict()) if as_json else sheet(found, habitat))


def sheet(found: "Evaluation", changes: dict[str, Any]) -> str:
    """What came out, in a few lines."""
    told = found.to_dict()
    games = "1 game" if found.games == 1 else f"{found.games:,} games"
    with_ = "".join(f", {name} {value}" for name, value in changes.items())
    same = f"{found.distinct:,} distinct game{'s' * (found.distinct != 1)}"
    lines = [
        f"organism {found.organism} of world {found.world}: {games}{with_}{SENSES[found.senses]}",
        f"  {same}{'; nothing is drawn at random, so all are the same' * (found.games == 1)}",
        f"  lifespan  {_spread(told['lifespan'])}{_cut(told['alive_when_cut'], 'alive')}",
    ]
    if "score" in told:
        lines.append(f"  score     {_spread(told['score'])}")
        lines.append(f"  length    {_spread(told['length'])}{_cut(told['cut'], 'going on')}")
    return "\n".join(lines)


def _spread(of: dict[str, float]) -> str:
    if of["q1"] == of["maximum"]:
        return f"{of['median']:,.0f}"
    quartiles = f"quartiles {of['q1']:,.0f}, {of['q3']:,.0f}"
    return f"median {of['median']:,.0f} ({quartiles}), maximum {of['maximum']:,.0f}"


def _cut(count: int, what: str) -> str:
    return f"; {count:,} still {what} when cut" if count else ""


COMMANDS = (evaluate,)
