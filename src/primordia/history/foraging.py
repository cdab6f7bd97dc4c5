"""Food that organisms gathered over time, from the metrics and the state."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from primordia.history.climate import Climates, PastClimate
from primordia.law.metabolism import ONE, break_even
from primordia.runs.arrays import read_count
from primordia.runs.records import Records

TOTALS = "tick", "food", "organism_ticks"
STRETCHES = 60
"""Largest number of intervals of a world's time."""


class Foraging(NamedTuple):
    """The foraging of W worlds in N successive intervals of time."""

    first_tick: int
    """tick at the end of which the first interval begins"""
    middle: np.ndarray
    """tick in the middle of each interval, float64 (N,)"""
    food: np.ndarray
    """mean food of an organism in a tick, float64 (W, N); NaN if no organism lived"""
    break_even: np.ndarray
    """amount of food in a tick with which energy stays constant, float64 (W, N); infinite if there
    is no such amount"""


class Harvest(NamedTuple):
    """Running totals of one world at its beginning, at its samples and at its end, each (S,)."""

    tick: np.ndarray
    """float64, ascending from 0 or from the tick of the fork"""
    food: np.ndarray
    """food gathered, float64"""
    lived: np.ndarray
    """organism-ticks, float64"""

    def between(self, ticks: np.ndarray) -> np.ndarray:
        """Return the mean food per organism-tick in each interval between successive `ticks`, float64.

        The mean is NaN if no organism lived.
        """
        food, lived = (np.diff(np.interp(ticks, self.tick, each)) for each in self[1:])
        return np.divide(food, lived, out=np.full(len(food), np.nan), where=lived > 0)


def harvests(run: Records, worlds: int) -> list[Harvest]:
    """Return a run's harvest in each world numbered below `worlds`."""
    world = run.metrics["world"].to_numpy()
    columns = [run.metrics[name].to_numpy() for name in TOTALS]
    begun = np.zeros((len(TOTALS), worlds))
    if run.origin is not None:
        begun = _totals(partial(read_count, run.origin))
    ended = _totals(run.count)
    found = []
    for number in range(worlds):
        sampled = np.array([column[world == number] for column in columns], float)
        totals = np.column_stack([begun[:, number], sampled, ended[:, number]])
        _, first = np.unique(totals[0], return_index=True)  # the last sample may be at the end
        found.append(Harvest._make(totals[:, first]))
    return found


def _totals(count: Callable[[str], np.ndarray]) -> np.ndarray:
    """Return the TOTALS of each world in a state, float64 (3, W)."""
    tick, food, lived = (count(f"world.worlds.{name}").astype(np.int64) for name in TOTALS)
    return np.array([tick, food / ONE, lived])


def foraging(run: Records) -> Foraging:
    """Return the foraging of all worlds of a run that has a metabolism."""
    worlds = run.config.seeds
    totals = harvests(run, worlds)
    samples = max(len(harvest.tick) for harvest in totals) - 1
    last = max(int(harvest.tick[-1]) for harvest in totals)
    first = min(int(harvest.tick[0]) for harvest in totals)
    edges = np.linspace(first, last, min(STRETCHES, samples) + 1)
    middle = (edges[1:] + edges[:-1]) / 2
    past = PastClimate(run)
    enough = [_break_even(past.of_worlds(np.full(len(middle), w), middle)) for w in range(worlds)]
    food = [harvest.between(edges) for harvest in totals]
    return Foraging(first, middle, np.array(food), np.array(enough))


def _break_even(climate: Climates) -> np.ndarray:
    """Return the food in a tick that keeps energy constant, (n,); infinite if no amount does."""
    pairs = zip(climate["metabolism.drain"], climate["metabolism.gain"], strict=True)
    foods = (break_even(float(drain), float(gain)) for drain, gain in pairs)
    return np.array([np.inf if food is None else food for food in foods])
