"""Speed of a run on each core, as campaigns have them, against the bare simulators.

Two runs of 4 worlds of 32 cells on two cores, for each game and robot: births and records are included,
checkpoints are not. Each has a process (`contender.py`) that uses one core.

`bare` are the same simulators in the same processes under the same controls, without law, brains and
records (`tapes.py`); emulators and bodies reach the same states, which is checked. `one run` has all
worlds on all cores. The others have the same brains, and no law. Ways take turns. Shares are given of
rates by the clock, and of processor time, which counts where other programs use the machine.
"""

from contextlib import ExitStack
from typing import Any

from contenders.loop import TASKS
from hosted import FULL
from primordia import cores
from processes import Contender
from worlds import median

CELLS, WORLDS = 32, 4
"""cells of a world, worlds of a job; there are as many jobs as cores"""
WAYS = {
    "jobs": ("ours", True),
    "one run": ("ours", False),
    "sync, a process a core": ("sync", True),
    "envpool, a process a core": ("envpool", True),
    "envpool, one process": ("envpool", False),
}
"""The way of `contender.py`, and whether it has a process for each core."""
BAR, AIM = 0.85, 0.95
"""shares of the bare simulators' rate"""
ROUNDS = 5
SECONDS = 2.0


def against_bare_simulators() -> list[dict]:
    """Measure each game and robot."""
    return [_measured(game) for game in TASKS]


def _measured(game: str) -> dict:
    """Measure the rates of all ways for a game, in turn."""
    begun: dict[str, Contender] = {}
    greetings: dict[str, dict] = {}
    with ExitStack() as stack:
        for name, (way, one_core_each) in WAYS.items():
            worlds = WORLDS if one_core_each else WORLDS * cores.count()
            contender = Contender(way, game, CELLS, worlds, one_core_each)
            begun[name] = stack.enter_context(contender)
            # one way after the other, since emulators start slowly
            greetings[name] = contender.answers()[0]
        playing = {way: begun[way] for way in WAYS if "about" in greetings[way]}
        rounds = [_one_round(playing) for _ in range(ROUNDS)]
        budget = begun["jobs"].ask("budget", SECONDS)[0]
    remarks = {way: greeting.get("about", greeting) for way, greeting in greetings.items()}
    return {"game": game, **_summary(rounds), "budget": budget, "ways": remarks}


def _one_round(ways: dict[str, Contender]) -> dict[str, Any]:
    """Let all ways play in turn; return frames per second, and what the jobs lived."""
    jobs, *others = ways
    lived, alone = ways[jobs].ask("record", SECONDS), ways[jobs].ask("alone", SECONDS)
    both = list(zip(lived, alone, strict=True))
    rates = {
        "bare": sum(a["frames"] / b["alone"] for a, b in both),
        "jobs": sum(a["frames"] / a["seconds"] for a in lived),
    }
    for way in others:
        answers = ways[way].ask("play", SECONDS)
        rates[way] = sum(each["frames"] / each["seconds"] for each in answers)
    used = sum(b["alone, cpu"] for b in alone) / sum(a["cpu"] for a in lived)
    return {"rates": rates, "used": used, "lived": lived}


def _summary(rounds: list[dict]) -> dict[str, Any]:
    """Return medians of rates, and of their ratios round by round.

    Raises:
        RuntimeError: the worlds were not full enough for the figures to count.
    """
    rates = [each["rates"] for each in rounds]
    lived = [answer for each in rounds for answer in each["lived"]]
    whole = {name: sum(each[name] for each in lived) for name in ("frames", "births", "ticks")}
    full = whole["frames"] / (whole["ticks"] * CELLS)
    if full < FULL:
        raise RuntimeError(f"only {full:.3f} of the cells were occupied; {FULL} are wanted")
    ways = [way for way in rates[0] if way != "bare"]
    shares = {way: [each[way] / each["bare"] for each in rates] for way in ways}
    return {
        "frames per s": {way: median([each[way] for each in rates]) for way in rates[0]},
        "of bare": {way: median(values) for way, values in shares.items()},
        "of bare, each round": shares["jobs"],
        "of bare, processor time": median([each["used"] for each in rounds]),
        "bar, aim": (BAR, AIM),
        "births per 1,000 ticks": 1000 * whole["births"] / whole["ticks"],
        "full": full,
    }
