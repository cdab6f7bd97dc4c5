"""Survival: the share alive at each age (Kaplan and Meier 1958); resamples draw whole worlds.

Organisms alive at a fork count from their age at the fork (delayed entry: Kalbfleisch and Prentice
2002, section 1.3), since the fork has no record of the shorter lives of their generation.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import chain

import numpy as np

from primordia.comparison.resample import RESAMPLES, interval, resamples
from primordia.runs.lives import Lives


@dataclass(frozen=True)
class Survival:
    """Deaths and organisms at risk in each of W worlds, at each of A ages with a death.

    Lives count up to a limit of age; a longer life counts as survival to the limit. The living are
    censored at their present age. A curve is constant after the last observed age.
    """

    limit: int
    """age, in ticks, up to which lives count"""
    ages: np.ndarray
    """int64 (A,), ascending, up to the limit: ages with at least one death"""
    deaths: np.ndarray
    """int64 (W, A)"""
    at_risk: np.ndarray
    """int64 (W, A): organisms on record at this age, alive and not censored before"""
    longest: np.ndarray
    """int64 (W,): the longest life in each world, at most the limit"""

    @cached_property
    def curve(self) -> np.ndarray:
        """Share alive after each age, with the lives of all worlds pooled, float64 (A,)."""
        return _alive(self.deaths.sum(0), self.at_risk.sum(0))

    @property
    def steps(self) -> np.ndarray:
        """Ages at which a curve has values, from 0 to the limit, (A + 2,)."""
        return np.concatenate([[0], self.ages, [self.limit]])

    def with_ends(self, curve: np.ndarray) -> np.ndarray:
        """Return a curve (A,) with values at both ends, (A + 2,): 1 at age 0, and the last value at
        the limit."""
        alive = np.insert(curve, 0, 1.0)
        return np.append(alive, alive[-1])

    @cached_property
    def band(self) -> tuple[np.ndarray, np.ndarray]:
        """Pointwise 95 % interval of the pooled curve over resamples of whole worlds, each (A,)."""
        worlds = len(self.deaths)
        curves = np.empty((RESAMPLES, len(self.ages)), np.float32)
        deaths, at_risk = self.deaths.astype(float), self.at_risk.astype(float)
        for row, resample in enumerate(chain.from_iterable(resamples(worlds))):
            times = np.bincount(resample, minlength=worlds).astype(float)
            curves[row] = _alive(times @ deaths, times @ at_risk)
        return interval(curves)

    @cached_property
    def restricted_mean(self) -> np.ndarray:
        """Mean lifespan up to the limit in each world, ticks, float64 (W,): the area under its curve.

        The area ends at the world's longest life: nothing is known of later ages (Efron 1967). So it is
        a lower bound if organisms are still alive at that age.
        """
        alive = np.insert(_alive(self.deaths, self.at_risk), 0, 1.0, axis=-1)
        ends = np.minimum(self.steps, self.longest[:, None])
        return (alive * np.diff(ends, axis=1)).sum(axis=1)


def survival(lives: Lives, worlds: int, limit: int) -> Survival:
    """Return the survival of lives in a number of worlds, up to a limit of age in ticks."""
    died = lives.died & (lives.lifespan <= limit)
    ages = np.unique(lives.lifespan[died])
    deaths = np.zeros((worlds, len(ages)), np.int64)
    np.add.at(deaths, (lives.world[died], np.searchsorted(ages, lives.lifespan[died])), 1)
    # At risk at an age: lives that end at this age or later, minus lives whose record begins at
    # this age or later.
    reached, later = (
        _reaching(lives.world, each, worlds, ages) for each in (lives.lifespan, lives.entered)
    )
    longest = np.zeros(worlds, np.int64)
    np.maximum.at(longest, lives.world, lives.lifespan)
    return Survival(limit, ages, deaths, reached - later, longest.clip(max=limit))


def _reaching(world: np.ndarray, age: np.ndarray, worlds: int, ages: np.ndarray) -> np.ndarray:
    """Return the number of lives in each world that reach each of `ages`, int64 (W, A)."""
    last = np.zeros((worlds, len(ages) + 1), np.int64)
    np.add.at(last, (world, np.searchsorted(ages, age, side="right")), 1)
    return np.cumsum(last[:, ::-1], axis=1)[:, ::-1][:, 1:]


def _alive(deaths: np.ndarray, at_risk: np.ndarray) -> np.ndarray:
    """Return the product of the shares that survive each age; 1 if no organism is at risk."""
    return np.cumprod(1 - deaths / np.maximum(at_risk, 1), axis=-1)
