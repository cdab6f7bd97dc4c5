"""Selection coefficients and their null: what is put into a pedigree comes out of its measures."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.phylogeny.frequencies import founders, instants
from primordia.phylogeny.lines import lines_of_world, two_sided
from primordia.phylogeny.living import Census, Turnover, branches
from primordia.phylogeny.slopes import between, observed, of_shadows
from tests.pedigrees import HISTORY, Event, line_to, lives_of, living_after, moran, walked


def test_the_slope_is_that_of_weighted_least_squares() -> None:
    rng = np.random.default_rng(1)
    ticks, living = np.arange(100, 400, 10), 40 + 4 * np.arange(30)[::-1]
    counts = rng.integers(0, 41, (30, 2)) + 2 * np.arange(30)[::-1, None]
    share = counts / living[:, None]
    for line, slope in enumerate(observed(counts, living, ticks)):
        inside = (share[:, line] >= 0.05) & (share[:, line] <= 0.95)
        x = share[inside, line]
        weights = np.sqrt(living[inside] * x * (1 - x))  # polyfit squares them
        expected = np.polyfit(ticks[inside], np.log(x / (1 - x)), 1, w=weights)[0]
        assert slope == pytest.approx(expected, rel=1e-6)


def test_a_line_needs_some_instants_between_the_bounds() -> None:
    counts = np.array([[2, 2, 2, 2, 98, 98], [40, 41, 42, 43, 50, 100], [10, 20, 30, 40, 99, 99]]).T
    found = observed(counts, np.full(6, 100), np.arange(6))
    assert np.isfinite(found).tolist() == [False, True, False]


@pytest.mark.parametrize("living", [20, 60, 100, 1000])
def test_shares_of_5_and_of_95_percent_are_still_measured(living: int) -> None:
    low, high = living // 20, living - living // 20
    counts = np.array([0, low - 1, low, low + 1, high - 1, high, high + 1, living])
    assert between(counts, living).tolist() == [False, False, True, True, True, True, False, False]


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw fewer shadows of each line."""
    monkeypatch.setattr("primordia.phylogeny.slopes.MOST", 200)
    monkeypatch.setattr("primordia.phylogeny.drift.MOST", 40)


@pytest.mark.usefixtures("quick")
def test_without_selection_p_values_are_those_of_chance() -> None:
    """The lines of one world are not independent, so the bounds are wide."""
    names = range(100, 120, 2)
    worlds = [lines_of_world(0, moran(24, 600, name), None, name) for name in names]
    slopes = np.concatenate([each.p_of_slopes[np.isfinite(each.p_of_slopes)] for each in worlds])
    assert len(slopes) > 60
    assert 0.4 < slopes.mean() < 0.6
    for below in (0.1, 0.3, 0.6):
        assert (slopes < below).mean() == pytest.approx(below, abs=0.1)
    whole = np.array([each.p_of_effective for each in worlds])
    assert 0.35 < whole.mean() < 0.65
    assert (whole < 0.1).mean() < 0.25


def test_an_advantage_that_is_put_in_comes_out_as_the_slope() -> None:
    """Without it a founder's line has 1 - a times as many children, so s is about -ln(1 - a) / size."""
    size, advantage, found = 400, 0.2, []
    for k in range(6):
        lives = moran(size, 12_000, 300 + 2 * k, lambda row: 1.0 if row < 100 else 1 - advantage)
        own = founders(lives, 0)
        census = Census(lives, instants(0, 12_000))
        favoured = census.counts(branches(lives.parent_row, own), size)[:, :100].sum(axis=1)
        found += observed(favoured[:, None], census.living, census.ticks).tolist()
    assert np.mean(found) == pytest.approx(-np.log(1 - advantage) / size, rel=0.15)


@pytest.mark.usefixtures("quick")
def test_where_nothing_drifts_a_shadow_has_the_slope_of_its_line() -> None:
    """Lines keep their numbers while founders are born; the larger line begins later, below 95 %."""
    born = [0] * 40 + list(range(1, 41))
    lives = lives_of([-1] * 80, born, [40] * 80, [False] * 80)
    census = Census(lives, np.arange(0, 42, 2))
    counts = np.tile([39, 20], (21, 1))
    slopes = observed(counts, census.living, census.ticks)
    shadows = of_shadows(census, Turnover.of(lives), counts, seed=1)
    np.testing.assert_allclose(shadows, np.tile(slopes[:, None], 200), rtol=1e-9)


@given(history=HISTORY, starts=st.integers(1, 3), at=st.integers(0, 30))
def test_lines_are_the_descendants_of_the_living_at_a_tick(
    history: list[Event], starts: int, at: int
) -> None:
    lives = walked(history, starts)
    at = min(at, len(history))
    own = founders(lives, at)
    assert own.tolist() == living_after(lives, at)
    census = Census(lives, instants(at, len(history)))
    counts = census.counts(branches(lives.parent_row, own), len(own))
    for tick, row, living in zip(census.ticks.tolist(), counts, census.living, strict=True):
        now = living_after(lives, tick)
        first = [next((a for a in line_to(lives, each) if a in own), None) for each in now]
        assert row.tolist() == [first.count(each) for each in own.tolist()]
        assert living == len(now)


def test_p_values_count_the_value_itself_and_both_sides() -> None:
    null = np.arange(1.0, 10.0)
    values = np.array([0.0, 1.0, 2.0, 2.5, 5.0, 8.0, 9.0, 10.0])
    assert two_sided(values, null) == pytest.approx([0.2, 0.4, 0.6, 0.6, 1, 0.6, 0.4, 0.2])
