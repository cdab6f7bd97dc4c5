"""How many are still alive at an age: Kaplan-Meier (1958) over lives, with worlds as the units."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from primordia.comparison.resample import interval, resamples
from primordia.history.lives import Lives


@dataclass(frozen=True)
class Survival:
    """Deaths and those at risk, world by world, at each age at which somebody died.

    Lives count up to a limit of age; who lived longer survived to it. The living are censored at
    the age they have. After the last age that anybody was seen at, a curve stays as it is.
    """

    limit: int
    """ticks of age up to which lives count"""
    ages: np.ndarray
    """int64 (A,), rising, up to the limit: somebody died at each"""
    deaths: np.ndarray
    """int64 (W, A)"""
    at_risk: np.ndarray
    """int64 (W, A): who reached this age, and was not censored before"""

    @cached_property
    def curve(self) -> np.ndarray:
        """Share alive after each age, all worlds' lives pooled, float64 (A,)."""
        return _alive(self.deaths.sum(0), self.at_risk.sum(0))

    @cached_property
    def band(self) -> tuple[np.ndarray, np.ndarray]:
        """Pointwise 95 % interval of the pooled curve over resamples of whole worlds, (A,) each."""
        worlds = len(self.deaths)
        curves = np.empty((len(drawn := resamples(worlds)), len(self.ages)), np.float32)
        deaths, at_risk = self.deaths.astype(float), self.at_risk.astype(float)
        for row, each in enumerate(drawn):
            times = np.bincount(each, minlength=worlds).astype(float)
            curves[row] = _alive(times @ deaths, times @ at_risk)
        return interval(curves)

    @cached_property
    def restricted_mean(self) -> np.ndarray:
        """Mean lifespan up to the limit in each world, ticks, float64 (W,): area under its curve."""
        alive = np.insert(_alive(self.deaths, self.at_risk), 0, 1.0, axis=-1)
        return alive @ np.diff(self.ages, prepend=0, append=self.limit).astype(float)


def survival(lives: Lives, worlds: int, limit: int) -> Survival:
    """Of the lives of so many worlds, up to a limit of age in ticks."""
    died = lives.died & (lives.lifespan <= limit)
    ages = np.unique(lives.lifespan[died])
    deaths = np.zeros((worlds, len(ages)), np.int64)
    np.add.at(deaths, (lives.world[died], np.searchsorted(ages, lives.lifespan[died])), 1)
    # Everyone leaves after the last age not above the lifespan; at risk is who has not left before.
    left = np.zeros((worlds, len(ages) + 1), np.int64)
    np.add.at(left, (lives.world, np.searchsorted(ages, lives.lifespan, side="right")), 1)
    at_risk = np.cumsum(left[:, ::-1], axis=1)[:, ::-1][:, 1:]
    return Survival(limit, ages, deaths, at_risk)


def _alive(deaths: np.ndarray, at_risk: np.ndarray) -> np.ndarray:
    """Product over ages of the share that gets past each; where nobody is at risk, all do."""
    return np.cumprod(1 - deaths / np.maximum(at_risk, 1), axis=-1)
