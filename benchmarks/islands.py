"""An archipelago against its islands alone: seconds for the same ticks of the same cells.

A control tells what islands cost from what a larger world costs: equal islands against the plain world of
all their cells, which live the same lives.
"""

import statistics
import sys
import time
from itertools import chain
from typing import Any

from primordia.config import Config, load
from primordia.engine.engine import Engine

PAIRS = 7
WORLDS: dict[str, tuple[str, dict[str, Any], int]] = {
    "8 gravities, 16 cells each": (
        "CartPole-survival",
        {
            "cells": 128,
            "hazard": 0.001,
            "habitat": {
                "islands": [
                    {"name": f"g{k}", "habitat": {"factors": {"gravity": 0.4 * 1.4**k}}}
                    for k in range(8)
                ]
            },
        },
        20_000,
    ),
    "5 games of MinAtar, 64 cells each": (
        "MinAtar-Breakout-survival",
        {
            "cells": 320,
            "brain": {"kind": "recurrent", "hidden": 32},
            "habitat": {
                "sticky": 0.0,
                "islands": [
                    {"name": name.lower(), "habitat": {"env": f"{name}-MinAtar"}}
                    for name in ("Asterix", "Breakout", "Freeway", "SpaceInvaders", "Seaquest")
                ],
            },
        },
        100,
    ),
    "4 games of Atari, 16 cells each": (
        "Pong-survival",
        {
            "cells": 64,
            "placement": {"topology": "well-mixed"},
            "habitat": {
                "senses": [],
                "sticky": 0.25,
                "fatal": "game_over",
                "islands": [
                    {"name": game, "habitat": {"game": game}}
                    for game in ("pong", "boxing", "breakout", "freeway")
                ],
            },
        },
        300,
    ),
}


def against_islands_alone(names: tuple[str, ...] = tuple(WORLDS)) -> list[dict]:
    """Return, for each archipelago, its seconds as a multiple of those of its islands alone, and the
    seconds of equal islands as a multiple of those of a plain world."""
    rows = []
    for name in names:
        task, settings, ticks = WORLDS[name]
        config = load(task, {"genesis": "fill", **settings})
        alone = _plain_worlds(config)
        large = alone[0].model_copy(update={"cells": config.cells})
        equal = [{"name": each} for each in config.islands.names]
        drawn = large.model_copy(update={"habitat": {**large.habitat, "islands": equal}})
        rows.append({
            "world": name,
            **compared("alone", [config], alone, ticks),
            **compared("equal_islands", [drawn], [large], ticks),
        })  # fmt: skip
    return rows


def compared(about: str, one: list[Config], other: list[Config], ticks: int) -> dict[str, Any]:
    """Return the seconds of some worlds, of others, and the ratios of pairs."""
    sides = [[Engine(each) for each in side] for side in (one, other)]
    for engine in chain(*sides):
        _seconds(engine, ticks)  # compiles
    pairs = [
        [sum(_seconds(engine, ticks) for engine in side) for side in sides] for _ in range(PAIRS)
    ]
    for engine in chain(*sides):
        if engine.habitat.kind == "host":
            engine.habitat.close()
    ratios = [first / second for first, second in pairs]
    return {
        f"seconds_{about}": [statistics.median(side) for side in zip(*pairs, strict=True)],
        f"ratio_{about}": statistics.median(ratios),
        f"ratios_{about}": [round(each, 3) for each in ratios],
    }


def _plain_worlds(config: Config) -> list[Config]:
    """Return a plain world like each island, with as many cells."""
    sizes = zip(config.by_island, config.islands.sizes, strict=True)
    return [each.model_copy(update={"cells": size}) for each, size in sizes]


def _seconds(engine: Engine, ticks: int) -> float:
    """Live a new world of the same seed for some ticks, and return the seconds that it took."""
    engine.state = engine.chunks.begin(engine.config.world_seeds)
    limits = engine.limits({"ticks": ticks})
    began = time.perf_counter()
    while engine.any_running(limits):
        engine.advance(limits)
    return time.perf_counter() - began


if __name__ == "__main__":
    for row in against_islands_alone(tuple(sys.argv[1:]) or tuple(WORLDS)):
        print(row, flush=True)
