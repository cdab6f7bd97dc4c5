"""Cost of the live view: organism-ticks per second with it, and without.

    python benchmarks/show.py

Pairs take turns. Where other programs use the machine, the share of processor time counts: that of the
view, in all that the process used.
"""

import os
import time

from rich.console import Console

from primordia.engine.engine import Engine
from primordia.live.view import View
from primordia.runs.loop import Listener, Status
from worlds import engine, median, organism_ticks, saturated_phase

ROUNDS = 7
SECONDS = 2.0
TORUS = {"topology": "torus8"}
BAR = 0.03
"""largest share that the view may take"""


def cost_of_the_live_view() -> list[dict]:
    """Measure saturated worlds, and worlds in which accidents keep lives short."""
    busy = engine(32, genesis="fill", hazard=0.02)
    large = engine(1024, genesis="fill", placement=TORUS)
    return [
        _cost("saturated ring", saturated_phase(32, 1), (80, 24)),
        _cost("ring with accidents", busy, (80, 24)),
        _cost("torus of 1,024 cells", large, (120, 40)),
        _cost("torus, an organism beside it", large, (120, 40), "o"),
    ]


def _cost(phase: str, made: Engine, size: tuple[int, int], keys: str = "") -> dict:
    """Measure one world with and without the view, in turn; `keys` are pressed after the first chunk."""
    alone, watched, ratios, shares = [], [], [], []
    width, height = size
    _rate(made, lambda _: None)  # which compiles
    with open(os.devnull, "w") as nowhere:
        for _ in range(ROUNDS):
            console = Console(
                file=nowhere,
                force_terminal=True,
                color_system="truecolor",
                width=width,
                height=height,
            )
            alone.append(_rate(made, lambda _: None)[0])
            with View(console) as view:
                made.advance(made.limits({}))
                status = Status(made, 0.0, made.limits({}))
                view(status)
                for key in keys:
                    view._obey(key, status)
                rate, share = _rate(made, view)
            watched.append(rate)
            ratios.append(rate / alone[-1])
            shares.append(share)
    return {
        "phase": phase,
        "terminal": f"{width} x {height}",
        "rates": {"alone": median(alone), "watched": median(watched)},
        "ratio": median(ratios),
        "ratios": ratios,
        "share of processor time": median(shares),
        "bar": BAR,
    }


def _rate(made: Engine, listen: Listener) -> tuple[float, float]:
    """Return organism-ticks per second, and the listener's share of the processor time."""
    limits, lived, listening = made.limits({}), organism_ticks(made), 0.0
    began, used = time.perf_counter(), time.process_time()
    while (now := time.perf_counter()) - began < SECONDS:
        made.advance(limits)
        before = time.process_time()
        listen(Status(made, now - began, limits))
        listening += time.process_time() - before
    rate = (organism_ticks(made) - lived) / (now - began)
    return rate, listening / (time.process_time() - used)


if __name__ == "__main__":
    for each in cost_of_the_live_view():
        print(each)
