"""CartPole worlds in memory, brought to a phase of their life and timed."""

import statistics
import time

import jax
import numpy as np

from primordia.config import load
from primordia.loop import Engine
from primordia.wide import to_host

NO_END = {"until": None}


def engine(cells: int, worlds: int = 1, **settings: object) -> Engine:
    """A CartPole-survival engine before genesis."""
    return Engine(load("CartPole-survival", {"cells": cells, "seeds": worlds, **settings}))


def random_phase(cells: int, worlds: int) -> Engine:
    """Worlds that never get anywhere: no heredity, and bodies that all die soon."""
    return advanced(engine(cells, worlds, **RANDOM), 500)


RANDOM = {
    "inheritance": "founder",
    "genesis": "fill",
    "mutation": {"founder_scale": 1.0},  # of such founders none lives 10,000 ticks
}


def saturated_phase(cells: int, worlds: int) -> Engine:
    """Worlds full of organisms that do not die any more."""
    made = engine(cells, worlds, mutation={"probability": 0.0})
    limits = made.limits({"until": "saturation", "ticks": 2_000_000})
    while made.any_running(limits):
        made.advance(limits)
    return made


def advanced(made: Engine, ticks: int) -> Engine:
    """The engine, so many ticks on."""
    limits = made.limits({"ticks": int(to_host(made.state.world.worlds.tick).max()) + ticks})
    while made.any_running(limits):
        made.advance(limits)
    return made


def organism_ticks(made: Engine) -> int:
    """Lived so far, in all worlds."""
    return int(to_host(made.state.world.worlds.organism_ticks).sum())


def rate(made: Engine, seconds: float) -> float:
    """Organism-ticks per second over about so many seconds."""
    limits = made.limits({})
    made.advance(limits)
    began, lived = time.perf_counter(), organism_ticks(made)
    while time.perf_counter() - began < seconds:
        made.advance(limits)
    jax.block_until_ready(made.state)
    return (organism_ticks(made) - lived) / (time.perf_counter() - began)


def median(values: list[float]) -> float:
    """Median, as a float."""
    return float(statistics.median(values))


def spread(values: list[float]) -> dict[str, float]:
    """Median and quartiles."""
    low, middle, high = np.percentile(values, [25, 50, 75])
    return {"q1": float(low), "median": float(middle), "q3": float(high)}
