"""An archipelago against its islands alone: seconds for the same ticks of the same cells."""

import statistics
import sys
import time
from typing import Any

from primordia.config import Config, load
from primordia.engine.engine import Engine

PAIRS = 5
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
            "habitat": {
                "islands": [
                    {"name": name.lower(), "habitat": {"env": f"{name}-MinAtar"}}
                    for name in ("Asterix", "Breakout", "Freeway", "SpaceInvaders", "Seaquest")
                ]
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
    """Return, for each archipelago, its seconds as a multiple of those of its islands alone."""
    rows = []
    for name in names:
        task, settings, ticks = WORLDS[name]
        config = load(task, {"genesis": "fill", **settings})
        whole, alone = Engine(config), [Engine(each) for each in _plain_worlds(config)]
        _seconds(whole, ticks)  # compiles
        for each in alone:
            _seconds(each, ticks)
        pairs = [
            (_seconds(whole, ticks), sum(_seconds(each, ticks) for each in alone))
            for _ in range(PAIRS)
        ]
        ratios = [together / apart for together, apart in pairs]
        rows.append({
            "world": name,
            "seconds_together": statistics.median(pair[0] for pair in pairs),
            "seconds_apart": statistics.median(pair[1] for pair in pairs),
            "ratio": statistics.median(ratios),
            "ratios": [round(each, 3) for each in ratios],
        })  # fmt: skip
    return rows


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
