"""Survival of lives by Kaplan and Meier, also in forks, with a band from resampled worlds."""

from itertools import chain

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

from primordia.comparison.resample import interval, resamples
from primordia.comparison.survival import survival
from primordia.runs.lives import ALIVE, Lives


def restricted_mean(lives: list[tuple[int, bool]], limit: int) -> float:
    """Return the restricted mean, age by age: how many lives reach the age, and how many end there.

    It ends with the longest life.
    """
    alive, area = 1.0, 0.0
    for age in range(min(limit, max(lived for lived, _ in lives))):
        area += alive
        reach = [died and lived == age + 1 for lived, died in lives if lived >= age + 1]
        alive *= 1 - sum(reach) / len(reach) if reach else 1.0
    return area


LIFE = st.tuples(st.integers(1, 30), st.booleans())
LIVED = st.lists(st.lists(LIFE, min_size=1, max_size=12), min_size=1, max_size=6)


def made(worlds: list[list[tuple[int, bool]]]) -> Lives:
    """Return worlds of lives of given lengths, each ended or not."""
    rows = [(world, *life) for world, lives in enumerate(worlds) for life in lives]
    world, lifespan, died = (np.array(column) for column in zip(*rows, strict=True))
    nothing = np.zeros(len(rows), np.int64)
    cause = np.where(died, 0, ALIVE).astype(np.int8)
    times = {"born": nothing, "seen": nothing, "inherited": nothing > 0, "ended": lifespan}
    return Lives(world, nothing, nothing - 1, nothing, nothing, **times, cause=cause)


@given(LIVED, st.integers(1, 40))
def test_survival_is_the_estimate_of_kaplan_and_meier(
    worlds: list[list[tuple[int, bool]]], limit: int
) -> None:
    lives = made(worlds)
    estimate = survival(lives, len(worlds), limit)
    split = scipy.stats.CensoredData(lives.lifespan[lives.died], right=lives.lifespan[~lives.died])
    expected = scipy.stats.ecdf(split).sf.evaluate(estimate.ages)
    np.testing.assert_allclose(estimate.curve, expected, atol=1e-12)
    deaths = {age for lived in worlds for age, died in lived if died and age <= limit}
    np.testing.assert_array_equal(estimate.ages, sorted(deaths))
    np.testing.assert_array_equal(estimate.steps, [0, *estimate.ages, limit])
    np.testing.assert_array_equal(
        estimate.with_ends(estimate.curve), [1, *estimate.curve, (1, *estimate.curve)[-1]]
    )
    for lived, mean in zip(worlds, estimate.restricted_mean, strict=True):
        assert mean == pytest.approx(restricted_mean(lived, limit))


def test_the_band_is_that_of_resampled_worlds() -> None:
    draws = np.random.default_rng(1)
    worlds = [
        [(int(life), True) for life in draws.geometric(rate, 40)] for rate in (0.1, 0.2, 0.3, 0.5)
    ]
    estimate = survival(made(worlds), 4, 20)
    curves = []
    for drawn in chain.from_iterable(resamples(4)):
        lifespans = np.array([life for world in drawn for life, _ in worlds[world]])
        curves.append([(lifespans > age).mean() for age in estimate.ages])
    low, high = interval(np.array(curves))
    np.testing.assert_allclose(estimate.band[0], low, atol=1e-6)
    np.testing.assert_allclose(estimate.band[1], high, atol=1e-6)
    assert (low < estimate.curve).any()
    assert (estimate.curve < high).any()
