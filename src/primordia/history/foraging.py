"""Food that organisms gathered over time, from the metrics."""

from typing import NamedTuple

import numpy as np

from primordia.history.climate import Climates, PastClimate
from primordia.law.metabolism import ONE, break_even
from primordia.runs.arrays import read_count
from primordia.runs.records import Records

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
    """Running totals of one world at its beginning and at its S samples, each (S + 1,)."""

    tick: np.ndarray
    """int64, ascending from 0 or from the tick of the fork"""
    food: np.ndarray
    """food gathered, float64"""
    lived: np.ndarray
    """organism-ticks, float64"""

    def between(self, ticks: np.ndarray) -> np.ndarray:
        """Return the mean food per organism-tick in each interval between successive `ticks`, float64.

        The mean is NaN if no organism lived.
        """
        food, lived = (np.diff(np.interp(ticks, self.tick, each)) for each in self[1:])
        return np.where(lived > 0, food / np.maximum(lived, 1), np.nan)


def harvests(run: Records, worlds: int) -> list[Harvest]:
    """Return a run's harvest in each world numbered below `worlds`."""
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


def _beginning(run: Records, worlds: int) -> list[np.ndarray]:
    """Return tick, food and organism-ticks of each world before its first recorded tick, each (W,)."""
    if run.origin is None:
        return [np.zeros(worlds, np.int64)] * 3
    names = "tick", "food", "organism_ticks"
    tick, food, lived = (
        read_count(run.origin, f"world.worlds.{name}").astype(np.int64) for name in names
    )
    return [tick, food / ONE, lived]


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
