"""How near worlds on the host come to the bare simulator, and what other ways of playing reach.

Each way has a process of its own (`contender.py`), told over pipes to play for some seconds, in turn.
`bare` has as many as cores, and neither it nor `batch` has brains. The others of 32 cells have the same
brains as ours, with random weights, but no law: nobody is born, dies or is recorded.
"""

import json
import os
import select
import subprocess
import sys
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from contenders.loop import ROBOTS, TASKS
from primordia.config import load
from worlds import median

GAMES = "pong", "battle_zone"
SIZES = {
    32: ("bare", "ours", "in step", "async", "sync", "published", "envpool"),
    128: ("bare", "ours", "in step"),
}
"""Ways that are set against each other at so many cells, the first as what cannot be passed."""
ROBOT_SIZES = {32: ("batch", "ours", "async", "sync", "envpool"), 256: ("batch", "ours")}
ROUNDS = 5
STARTS = 3
SECONDS = 1.0
FULL = 0.95
"""share of cells that must be occupied for a figure to count"""
PATIENCE = 120.0
"""seconds after which a process that has not answered is given up"""


def against_the_emulator() -> dict:
    """Start-up, and rates in turn, round by round, for each game and size."""
    worlds = [_measured(game, cells, ways) for game in GAMES for cells, ways in SIZES.items()]
    starts = {game: _start_up(game) for game in GAMES}
    return {"seconds until 32 emulators are up": starts, "worlds": worlds}


def against_the_batch() -> list[dict]:
    """Rates of robots in turn, round by round, for each robot and size."""
    return [_measured(robot, n, ways) for robot in ROBOTS for n, ways in ROBOT_SIZES.items()]


def _start_up(game: str) -> float:
    """Seconds from the order to the last worker's answer, the median of some."""
    habitat: Any = load(TASKS[game]).build_habitat()
    taken = []
    for _ in range(STARTS):
        began = time.perf_counter()
        habitat.open(32)
        taken.append(time.perf_counter() - began)
        habitat._pool.close()
    return median(taken)


class Contender:
    """A way of playing, in one process or in several that play at the same time."""

    def __init__(self, way: str, game: str, cells: int) -> None:
        count = len(os.sched_getaffinity(0)) if way == "bare" else 1
        words = [way, game, str(cells)]
        command = [sys.executable, str(Path(__file__).with_name("contender.py")), *words]
        self._way = f"{way} {game} {cells}"
        how: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        self._processes: list[Any] = [subprocess.Popen(command, **how) for _ in range(count)]

    def __enter__(self) -> "Contender":
        return self

    def __exit__(self, *_: object) -> None:
        """End of input ends them; one that does not listen is killed."""
        for process in self._processes:
            process.stdin.close()
        for process in self._processes:
            try:
                process.wait(timeout=10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            process.stdout.close()

    def ask(self, what: str, seconds: float) -> list[dict]:
        """What each process has to say of so many seconds, lived at the same time."""
        for process in self._processes:
            process.stdin.write(f"{what} {seconds}\n")
            process.stdin.flush()
        return self.answers()

    def answers(self) -> list[dict]:
        """The next line of each."""
        lines = []
        for process in self._processes:
            ready, _, _ = select.select([process.stdout], [], [], PATIENCE)
            line = process.stdout.readline() if ready else ""
            if not line:
                raise RuntimeError(f"no answer from contender.py {self._way}")
            lines.append(json.loads(line))
        return lines


def _measured(game: str, cells: int, ways: tuple[str, ...]) -> dict:
    """One game at one size: every way in turn, some rounds; then where a tick of ours goes."""
    with ExitStack() as stack:
        begun = {way: stack.enter_context(Contender(way, game, cells)) for way in ways}
        said = {way: contender.answers()[0] for way, contender in begun.items()}
        playing = {way: begun[way] for way in ways if "about" in said[way]}
        told: dict[str, list[list[dict]]] = {way: [] for way in playing}
        for _ in range(ROUNDS):
            for way, contender in playing.items():
                told[way].append(contender.ask("play", SECONDS))
        budget = playing["ours"].ask("budget", SECONDS)[0]
        if "batch" in playing:
            again = [playing["ours"].ask("again", SECONDS)[0] for _ in range(ROUNDS)]
            shares = [each["alone"] / each["seconds"] for each in again]
            budget["of the batch under our controls"] = median(shares)
    words = {way: said[way]["about"] for way in playing if said[way]["about"]}
    absent = {way: said[way]["not available"] for way in ways if way not in playing}
    words |= {way: f"not available: {why}" for way, why in absent.items()}
    found = {"game": game, "cells": cells, **_compared(told), **_lived(told["ours"], cells)}
    return {**found, "budget": budget, **({"ways": words} if words else {})}


def _compared(told: dict[str, list[list[dict]]]) -> dict:
    """Medians of frames per second, and of their ratios round by round."""
    rates = {
        way: [sum(each["frames"] / each["seconds"] for each in answers) for answers in rounds]
        for way, rounds in told.items()
    }

    def ratio(one: str, other: str) -> float:
        return median([a / b for a, b in zip(rates[one], rates[other], strict=True)])

    bare, *_ = rates
    others = [way for way in rates if way not in (bare, "ours")]
    found: dict[str, Any] = {
        "frames per s": {way: median(values) for way, values in rates.items()},
        "of bare": {way: ratio(way, bare) for way in rates if way != bare},
    }
    return {**found, "ours over": {w: ratio("ours", w) for w in others}} if others else found


def _lived(rounds: list[list[dict]], cells: int) -> dict[str, float]:
    """How often somebody was born, and how full the world was."""
    whole = {name: sum(r[0][name] for r in rounds) for name in ("frames", "births", "ticks")}
    full = whole["frames"] / (whole["ticks"] * cells)
    if full < FULL:
        raise RuntimeError(f"only {full:.3f} of {cells} cells were occupied; {FULL} are wanted")
    return {"births per 1,000 ticks": 1000 * whole["births"] / whole["ticks"], "full": full}
