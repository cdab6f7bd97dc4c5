"""What organisms gathered as time went on, from the metrics."""

from typing import NamedTuple

import numpy as np

from primordia.history.climate import climate_at
from primordia.law.metabolism import ONE, break_even
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import read_count

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


def harvests(run: Archive, worlds: int) -> list[Harvest]:
    """Of each of the first worlds of a run."""
    world = run.metrics["world"].to_numpy()
    columns = [run.metrics[name].to_numpy() for name in ("tick", "food", "organism_ticks")]
    begun = _beginning(run, worlds)
    return [
        Harvest._make(
            np.insert(column[world == number], 0, start[number])
            for column, start in zip(columns, begun, strict=True)
        )
        for number in range(worlds)
    ]


def _beginning(run: Archive, worlds: int) -> list[np.ndarray]:
    """Tick, food and organism-ticks of each world before its first tick on record, (W,) each."""
    if run.origin is None:
        return [np.zeros(worlds, np.int64)] * 3
    names = "tick", "food", "organism_ticks"
    tick, food, lived = (
        read_count(run.origin, f"world.worlds.{name}").astype(np.int64) for name in names
    )
    return [tick, food / ONE, lived]


def foraging(run: Archive) -> Foraging:
    """Of a run that has a metabolism."""
    worlds = run.config.seeds
    gathered = harvests(run, worlds)
    samples = max(len(harvest.tick) for harvest in gathered) - 1
    last = max(int(harvest.tick[-1]) for harvest in gathered)
    first = min(int(harvest.tick[0]) for harvest in gathered)
    edges = np.linspace(first, last, min(STRETCHES, samples) + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    enough = [_break_even(climate_at(run, world)(middle)) for world in range(worlds)]
    food = [harvest.between(edges) for harvest in gathered]
    return Foraging(first, middle, np.array(food), np.array(enough))


def _break_even(climate: dict[str, np.ndarray]) -> np.ndarray:
    pairs = zip(climate["metabolism.drain"], climate["metabolism.gain"], strict=True)
    each = (break_even(float(drain), float(gain)) for drain, gain in pairs)
    return np.array([np.inf if enough is None else enough for enough in each])
