"""What organisms gathered as time went on, from the metrics."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from primordia.config import Config
from primordia.history.climate import climate_at
from primordia.history.report import table
from primordia.law.metabolism import break_even

STRETCHES = 60
"""Most parts that a world's time is cut into."""


class Foraging(NamedTuple):
    """Of W worlds, in N stretches of time, one after another."""

    middle: np.ndarray
    """ticks, float64 (N,)"""
    food: np.ndarray
    """an organism gathered in a tick on average, float64 (W, N); NaN where nobody lived"""
    break_even: np.ndarray
    """food a tick that kept energy where it was, float64 (W, N); infinite where none did"""


class Harvest(NamedTuple):
    """All that had been gathered and lived in a world by each of its samples, S + 1 with the start."""

    tick: np.ndarray
    """int64, rising from 0"""
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
    return [
        Harvest._make(np.insert(column[world == number], 0, 0) for column in columns)
        for number in range(worlds)
    ]


def foraging(run: Path, config: Config) -> Foraging:
    """Of a run that has a metabolism."""
    gathered = harvests(run, config.seeds)
    samples = max(len(harvest.tick) for harvest in gathered) - 1
    last = max(int(harvest.tick[-1]) for harvest in gathered)
    edges = np.linspace(0, last, min(STRETCHES, samples) + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    law = config.build_law(config.build_habitat())
    enough = [_break_even(climate_at(run, config, law, w)(middle)) for w in range(config.seeds)]
    food = [harvest.between(edges) for harvest in gathered]
    return Foraging(middle, np.array(food), np.array(enough))


def _break_even(climate: dict[str, np.ndarray]) -> np.ndarray:
    pairs = zip(climate["metabolism.drain"], climate["metabolism.gain"], strict=True)
    each = (break_even(float(drain), float(gain)) for drain, gain in pairs)
    return np.array([np.inf if enough is None else enough for enough in each])
