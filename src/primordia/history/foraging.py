"""What organisms gathered as time went on, from the metrics."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from primordia.config import Config
from primordia.history.climate import climate_at
from primordia.law.metabolism import ONE, break_even
from primordia.runs import checkpoint
from primordia.runs.report import counts, table

STRETCHES = 60
"""Most parts that a world's time is cut into."""


class Foraging(NamedTuple):
    """Of W worlds, in N stretches of time, one after another."""

    since: int
    """tick at the end of which the first stretch begins"""
    middle: np.ndarray
    """ticks, float64 (N,)"""
    food: np.ndarray
    """an organism gathered in a tick on average, float64 (W, N); NaN where nobody lived"""
    break_even: np.ndarray
    """food a tick that kept energy where it was, float64 (W, N); infinite where none did"""


class Harvest(NamedTuple):
    """All gathered and lived in a world by each of its samples: S + 1 numbers, with the beginning."""

    tick: np.ndarray
    """int64, rising from 0, or from where it was forked"""
    food: np.ndarray
    """float64"""
    lived: np.ndarray
    """organism-ticks, float64"""

    def between(self, ticks: np.ndarray) -> np.ndarray:
        """Food an organism gathered in a tick between each two of `ticks`; NaN where nobody lived."""
        food, lived = (np.diff(np.interp(ticks, self.tick, each)) for each in self[1:])
        return np.where(lived > 0, food / np.maximum(lived, 1), np.nan)


def harvests(run: Path, worlds: int) -> list[Harvest]:
    """Of each world of a run."""
    metrics = table(run, "metrics")
    world = metrics["world"].to_numpy()
    columns = [metrics[name].to_numpy() for name in ("tick", "food", "organism_ticks")]
    begun = _beginning(run, worlds)
    return [
        Harvest._make(
            np.insert(column[world == number], 0, start[number])
            for column, start in zip(columns, begun, strict=True)
        )
        for number in range(worlds)
    ]


def _beginning(run: Path, worlds: int) -> list[np.ndarray]:
    """Tick, food and organism-ticks of each world before its first tick on record, (W,) each."""
    origin = checkpoint.origin(run)
    if origin is None:
        return [np.zeros(worlds, np.int64)] * 3
    names = "tick", "food", "organism_ticks"
    tick, food, lived = (
        counts(origin.arrays(), f"world.worlds.{name}").astype(np.int64) for name in names
    )
    return [tick, food / ONE, lived]


def foraging(run: Path, config: Config) -> Foraging:
    """Of a run that has a metabolism."""
    gathered = harvests(run, config.seeds)
    samples = max(len(harvest.tick) for harvest in gathered) - 1
    last = max(int(harvest.tick[-1]) for harvest in gathered)
    first = min(int(harvest.tick[0]) for harvest in gathered)
    edges = np.linspace(first, last, min(STRETCHES, samples) + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    law = config.build_law(config.build_habitat())
    enough = [_break_even(climate_at(run, config, law, w)(middle)) for w in range(config.seeds)]
    food = [harvest.between(edges) for harvest in gathered]
    return Foraging(first, middle, np.array(food), np.array(enough))


def _break_even(climate: dict[str, np.ndarray]) -> np.ndarray:
    pairs = zip(climate["metabolism.drain"], climate["metabolism.gain"], strict=True)
    each = (break_even(float(drain), float(gain)) for drain, gain in pairs)
    return np.array([np.inf if enough is None else enough for enough in each])
