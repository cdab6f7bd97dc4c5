"""CartPole worlds in memory, in a chosen phase, and their speed."""

import statistics
import time
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np

from primordia.config import load
from primordia.engine.engine import Engine
from primordia.random.wide import to_host


def engine(cells: int, worlds: int = 1, **settings: object) -> Engine:
    """Return a CartPole-survival engine before genesis."""
    return Engine(load("CartPole-survival", {"cells": cells, "seeds": worlds, **settings}))


def random_phase(cells: int, worlds: int) -> Engine:
    """Return worlds full of founders, before genesis."""
    return engine(cells, worlds, genesis="fill")


def random_rate(made: Engine, first_seed: int, ticks: int = 2000) -> float:
    """Return organism-ticks per second of the first ticks of new worlds, when most die young."""
    seeds = range(first_seed, first_seed + made.config.seeds)
    made.state = made.chunks.begin(np.array(seeds))
    began = time.perf_counter()
    advanced(made, ticks)
    return organism_ticks(made) / (time.perf_counter() - began)


def early_rate(made: Engine, seed: int, ticks: int) -> float:
    """Return organism-ticks per second of the first ticks of a new world, up to its last tick."""
    made.state = made.chunks.begin(np.array([seed]))
    limits = made.limits({"ticks": ticks})
    began = time.perf_counter()
    while made.any_running(limits):
        made.advance(limits)
    return organism_ticks(made) / (time.perf_counter() - began)


@cache
def undying() -> dict[str, np.ndarray]:
    """Return the genome, (1, ...) each, of an organism that does not die, evolved among 32 cells."""
    small = engine(32)
    limits = small.limits({"until": "saturation"})
    while small.any_running(limits):
        small.advance(limits)
    genome = small.state.world.organisms.genome
    return {name: np.asarray(block)[:1] for name, block in genome.items()}


def saturated_phase(cells: int, worlds: int, settled: int = 2000, **settings: object) -> Engine:
    """Return worlds full of copies of an organism that balances its pole, after some ticks."""
    copies = {"genesis": "fill", "mutation": {"probability": 0.0}}
    made = advanced(engine(cells, worlds, **copies, **settings), 1)
    organisms = made.state.world.organisms
    genome = {
        name: jnp.broadcast_to(block, organisms.genome[name].shape) + 0
        for name, block in undying().items()
    }
    world = made.state.world._replace(organisms=organisms._replace(genome=genome))
    made.state = made.state._replace(world=world)
    return advanced(made, settled)


def advanced(made: Engine, ticks: int) -> Engine:
    """Advance an engine by `ticks` and return it."""
    limits = made.limits({"ticks": int(to_host(made.state.world.worlds.tick).max()) + ticks})
    while made.any_running(limits):
        made.advance(limits)
    return made


def organism_ticks(made: Engine) -> int:
    """Return the organism-ticks lived so far in all worlds."""
    return int(to_host(made.state.world.worlds.organism_ticks).sum())


def rate(made: Engine, seconds: float) -> float:
    """Return organism-ticks per second over about `seconds`."""
    limits = made.limits({})
    made.advance(limits)
    began, lived = time.perf_counter(), organism_ticks(made)
    while time.perf_counter() - began < seconds:
        made.advance(limits)
    jax.block_until_ready(made.state)
    return (organism_ticks(made) - lived) / (time.perf_counter() - began)


def median(values: list[float]) -> float:
    """Return the median as a float."""
    return float(statistics.median(values))


def spread(values: list[float]) -> dict[str, float]:
    """Return median and quartiles."""
    low, middle, high = np.percentile(values, [25, 50, 75])
    return {"q1": float(low), "median": float(middle), "q3": float(high)}
