"""Cost of the live view: organism-ticks per second with it, and without."""

import os
import time

from rich.console import Console

from primordia.engine.engine import Engine
from primordia.live.view import View
from primordia.runs.loop import Listener, Status
from worlds import engine, median, organism_ticks, saturated_phase

ROUNDS = 7
SECONDS = 2.0


def cost_of_the_live_view() -> list[dict]:
    """Measure a saturated world, and a world in which accidents keep lives short."""
    busy = engine(32, genesis="fill", hazard=0.02)
    return [_cost("saturated", saturated_phase(32, 1)), _cost("random", busy)]


def _cost(phase: str, made: Engine) -> dict:
    """Measure one world with and without the view, in turn."""
    alone, watched, ratios, shares = [], [], [], []
    with open(os.devnull, "w") as nowhere:
        for _ in range(ROUNDS):
            console = Console(file=nowhere, force_terminal=True, width=80, height=24)
            alone.append(_rate(made, lambda _: None)[0])
            with View(console) as view:
                rate, share = _rate(made, view)
            watched.append(rate)
            ratios.append(rate / alone[-1])
            shares.append(share)
    rates = {"alone": median(alone), "watched": median(watched)}
    return {"phase": phase, "rates": rates, "ratio": median(ratios), "in the view": median(shares)}


def _rate(made: Engine, listen: Listener) -> tuple[float, float]:
    """Return organism-ticks per second, and the listener's share of the time."""
    limits, lived, listening = made.limits({}), organism_ticks(made), 0.0
    began = now = time.perf_counter()
    while now - began < SECONDS:
        made.advance(limits)
        before = time.perf_counter()
        listen(Status(made, before - began, limits))
        now = time.perf_counter()
        listening += now - before
    return (organism_ticks(made) - lived) / (now - began), listening / (now - began)
