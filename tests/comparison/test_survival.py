"""Survival of lives with worlds as units: Kaplan and Meier's, forks too; a band of worlds drawn again."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from primordia.comparison.resample import interval, resamples
from primordia.comparison.survival import survival
from primordia.runs.lives import ALIVE, Lives


def restricted_mean(lives: list[tuple[int, bool]], limit: int) -> float:
    """One age after the other: who reaches it, and who of those dies at it."""
    alive, area = 1.0, 0.0
    for age in range(limit):
        area += alive
        reach = [died and lived == age + 1 for lived, died in lives if lived >= age + 1]
        alive *= 1 - sum(reach) / len(reach) if reach else 1.0
    return area


LIFE = st.tuples(st.integers(1, 30), st.booleans())
LIVED = st.lists(st.lists(LIFE, min_size=1, max_size=12), min_size=1, max_size=6)


def made(worlds: list[list[tuple[int, bool]]]) -> Lives:
    """Lives of given lengths, each dead or not."""
    rows = [(world, *life) for world, lives in enumerate(worlds) for life in lives]
    world, lifespan, died = (np.array(column) for column in zip(*rows, strict=True))
    nothing = np.zeros(len(rows), np.int64)
    cause = np.where(died, 0, ALIVE).astype(np.int8)
    return Lives(world, nothing, nothing - 1, nothing, nothing, nothing, nothing, lifespan, cause)


@given(LIVED, st.integers(1, 40))
def test_survival_is_kaplan_and_meiers(worlds: list[list[tuple[int, bool]]], limit: int) -> None:
    lives = made(worlds)
    found = survival(lives, len(worlds), limit)
    split = stats.CensoredData(lives.lifespan[lives.died], right=lives.lifespan[~lives.died])
    expected = stats.ecdf(split).sf.evaluate(found.ages)
    np.testing.assert_allclose(found.curve, expected, atol=1e-12)
    np.testing.assert_array_equal(found.steps, [0, *found.ages, limit])
    np.testing.assert_array_equal(
        found.whole(found.curve), [1, *found.curve, (1, *found.curve)[-1]]
    )
    for lived, mean in zip(worlds, found.restricted_mean, strict=True):
        assert mean == pytest.approx(restricted_mean(lived, limit))


@given(LIVED, st.integers(0, 20), st.integers(1, 40))
def test_who_was_alive_at_a_fork_counts_from_the_age_of_then(
    worlds: list[list[tuple[int, bool]]], begun: int, limit: int
) -> None:
    lives = made(worlds).since(begun)
    assert (lives.lifespan[lives.died] > begun).all()
    assert (lives.entered == begun).all()
    found = survival(lives, len(worlds), limit)
    left = np.ones(len(worlds))
    for age in range(limit + 1):
        for world in range(len(worlds)):
            mine = lives.of_world(world)
            at_risk = ((mine.entered < age) & (mine.lifespan >= age)).sum()
            died = (mine.died & (mine.lifespan == age)).sum()
            left[world] *= 1 - died / max(at_risk, 1)
        if age in found.ages:
            which = found.ages.tolist().index(age)
            assert (found.at_risk[:, which] >= found.deaths[:, which]).all()
            each = np.cumprod(1 - found.deaths / np.maximum(found.at_risk, 1), axis=1)
            np.testing.assert_allclose(each[:, which], left, atol=1e-12)


def test_band_is_that_of_worlds_drawn_again() -> None:
    draws = np.random.default_rng(1)
    worlds = [
        [(int(life), True) for life in draws.geometric(rate, 40)] for rate in (0.1, 0.2, 0.3, 0.5)
    ]
    found = survival(made(worlds), 4, 20)
    curves = []
    for drawn in resamples(4):
        lifespans = np.array([life for world in drawn for life, _ in worlds[world]])
        curves.append([(lifespans > age).mean() for age in found.ages])
    low, high = interval(np.array(curves))
    np.testing.assert_allclose(found.band[0], low, atol=1e-6)
    np.testing.assert_allclose(found.band[1], high, atol=1e-6)
    assert (low < found.curve).any()
    assert (found.curve < high).any()
