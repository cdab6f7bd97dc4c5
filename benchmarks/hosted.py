"""Speed of worlds on the host, against the bare simulator and other ways of playing.

Each way has its own process (`contender.py`), which plays for some seconds on request; the ways take
turns. `bare` has one process for each core. `bare` and `batch` have no brains. The other ways of 32
cells have the same brains as ours, with random weights, but no law: no organism is born, dies or is
recorded. Ours is one run on all cores; `jobs.py` measures a run a core.
"""

import time
from contextlib import ExitStack
from typing import Any

from contenders.loop import ENVIRONMENTS, ROBOTS, TASKS
from primordia.config import load
from processes import Contender
from worlds import median

GAMES = "pong", "battle_zone"
SIZES = {
    32: ("bare", "ours", "in step", "async", "sync", "published", "envpool"),
    128: ("bare", "ours", "in step"),
}
"""The ways that are compared, by the number of cells; the first is the upper bound."""
ROBOT_SIZES = {32: ("batch", "ours", "async", "sync", "envpool"), 256: ("batch", "ours")}
ENVIRONMENT_WAYS = "sync", "ours", "async"
ROUNDS = 5
STARTS = 3
SECONDS = 1.0
FULL = 0.9
"""the least share of occupied cells for which a figure counts"""


def against_the_emulator() -> dict:
    """Measure the start-up of emulators, and the rates of all ways for each game and size, in turn."""
    worlds = [_measured(game, cells, ways) for game in GAMES for cells, ways in SIZES.items()]
    starts = {game: _start_up(game) for game in GAMES}
    return {"seconds until 32 emulators are up": starts, "worlds": worlds}


def against_the_batch() -> list[dict]:
    """Measure the rates of all ways for each robot and size, in turn."""
    return [_measured(robot, n, ways) for robot in ROBOTS for n, ways in ROBOT_SIZES.items()]


def against_gymnasium() -> list[dict]:
    """Measure the rates of all ways for Gymnasium's environments of pure Python, in turn."""
    return [_measured(env, 128, ENVIRONMENT_WAYS) for env in ENVIRONMENTS]


def _start_up(game: str) -> float:
    """Return the median of the seconds from the request to the last worker's answer."""
    habitat: Any = load(TASKS[game]).build_habitat()
    taken = []
    for _ in range(STARTS):
        began = time.perf_counter()
        habitat.open(32)
        taken.append(time.perf_counter() - began)
        habitat._pool.close()
    return median(taken)


def _measured(game: str, cells: int, ways: tuple[str, ...]) -> dict:
    """Measure one game at one size: the rates of all ways, and the shares of the parts of our tick."""
    with ExitStack() as stack:
        begun = {
            way: stack.enter_context(Contender(way, game, cells, one_core_each=way == "bare"))
            for way in ways
        }
        greetings = {way: contender.answers()[0] for way, contender in begun.items()}
        playing = {way: begun[way] for way in ways if "about" in greetings[way]}
        played: dict[str, list[list[dict]]] = {way: [] for way in playing}
        for _ in range(ROUNDS):
            for way, contender in playing.items():
                played[way].append(contender.ask("play", SECONDS))
        budget = playing["ours"].ask("budget", SECONDS)[0]
        if "batch" in playing:
            budget["of the batch under our controls"] = _of_the_batch(playing["ours"])
    remarks = {way: greetings[way]["about"] for way in playing if greetings[way]["about"]}
    absent = {way: greetings[way]["not available"] for way in ways if way not in playing}
    remarks |= {way: f"not available: {why}" for way, why in absent.items()}
    figures = {"game": game, "cells": cells, **_compared(played), **_lived(played["ours"], cells)}
    return {**figures, "budget": budget, **({"ways": remarks} if remarks else {})}


def _of_the_batch(ours: Contender) -> float:
    """Return our speed as a share of that of the simulators alone, under our controls."""
    shares = []
    for _ in range(ROUNDS):
        whole, alone = ours.ask("record", SECONDS)[0], ours.ask("alone", SECONDS)[0]
        shares.append(alone["alone"] / whole["seconds"])
    return median(shares)


def _compared(played: dict[str, list[list[dict]]]) -> dict:
    """Return the medians of frames per second, and of their ratios round by round."""
    rates = {
        way: [sum(a["frames"] / a["seconds"] for a in answers) for answers in rounds]
        for way, rounds in played.items()
    }

    def ratio(one: str, other: str) -> float:
        return median([a / b for a, b in zip(rates[one], rates[other], strict=True)])

    bare, *_ = rates
    others = [way for way in rates if way not in (bare, "ours")]
    figures: dict[str, Any] = {
        "frames per s": {way: median(values) for way, values in rates.items()},
        f"of {bare}": {way: ratio(way, bare) for way in rates if way != bare},
    }
    if others:
        figures["ours over"] = {way: ratio("ours", way) for way in others}
    return figures


def _lived(rounds: list[list[dict]], cells: int) -> dict[str, float]:
    """Return the rate of births and the share of occupied cells.

    Raises:
        RuntimeError: the world was not full enough for its figures to count.
    """
    whole = {name: sum(r[0][name] for r in rounds) for name in ("frames", "births", "ticks")}
    full = whole["frames"] / (whole["ticks"] * cells)
    if full < FULL:
        raise RuntimeError(f"only {full:.3f} of {cells} cells were occupied; {FULL} are wanted")
    return {"births per 1,000 ticks": 1000 * whole["births"] / whole["ticks"], "full": full}
