"""Numbers in figures equal those counted tick by tick and life by life."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.figures import survival
from primordia.history import series
from tests.synthetic import LIVED, alive, world_of


@given(lived=LIVED)
def test_population_and_mean_age_are_those_of_every_tick(
    lived: list[tuple[int, int, bool]],
) -> None:
    world = world_of(lived)
    ticks = np.arange(90)
    counted, mean = series.population(world, ticks), series.mean_age(world, ticks)
    for tick in ticks.tolist():
        ages = [tick - world.born[row] for row in range(len(world)) if alive(world, row, tick)]
        assert counted[tick] == len(ages)
        expected = np.mean(ages) if ages else np.nan
        np.testing.assert_allclose(mean[tick], expected, rtol=1e-12)


@given(lived=LIVED, inner=st.sets(st.integers(1, 89)))
def test_rates_are_deaths_over_ticks_lived(
    lived: list[tuple[int, int, bool]], inner: set[int]
) -> None:
    world = world_of(lived)
    edges = np.array([0, *sorted(inner), 90])
    exposed = series.exposure(world.born, world.ended, edges)
    risk = survival.hazard(world.born, world.ended, world.died, edges)
    for number, (low, high) in enumerate(pairwise(edges.tolist())):
        ticks = range(low + 1, high + 1)
        expected = sum(
            world.born[row] < tick <= world.ended[row]
            for row in range(len(world))
            for tick in ticks
        )
        died = sum(world.died[row] and world.ended[row] in ticks for row in range(len(world)))
        assert exposed[number] == expected
        assert (
            (risk[number] == died / expected)
            if died >= series.MIN_EVENTS
            else np.isnan(risk[number])
        )


def test_bins_are_five_for_each_factor_of_ten() -> None:
    assert series.bins(100).tolist() == [0, 1, 2, 3, 4, 6, 10, 16, 25, 40, 63, 100]
    assert series.bins(70).tolist() == [0, 1, 2, 3, 4, 6, 10, 16, 25, 40, 63, 70]
    assert series.bins(0).tolist() == [0, 1]


def test_the_middle_of_a_bin_is_that_of_its_ticks_on_a_logarithmic_axis() -> None:
    """The last bin has the ticks 3 to 10."""
    middle = series.middle(np.array([0, 1, 2, 10]))
    np.testing.assert_allclose(middle, [1, 2, np.sqrt(3 * 10)])


@pytest.mark.parametrize("last", [1, 10**6])
def test_curves_have_points_at_even_distances_on_a_logarithmic_axis(last: int) -> None:
    ticks = series.moments(last)
    assert ticks.tolist() == sorted({round(last ** (k / 999)) for k in range(1000)})


def test_a_run_without_ticks_has_one_point() -> None:
    assert series.moments(0).tolist() == [1]


def test_two_events_give_no_rate_and_three_do() -> None:
    at, edges = np.array([12, 1, 2, 10, 11, 15]), np.array([0, 10, 20])
    np.testing.assert_allclose(series.per_tick(at, np.array([30, 60]), edges), [3 / 30, 3 / 60])
    np.testing.assert_allclose(series.per_tick(at[1:], np.array([30, 60]), edges), [3 / 30, np.nan])


def test_a_curve_covers_the_ticks_on_record_of_each_world() -> None:
    """One world was forked in tick 20 and ends in 50; the other is on record from 30 to 60."""
    fork = world_of([(5, 40, True), (10, 0, False)], until=50).recorded_since(20)
    other = world_of([(30, 20, False)], until=60)
    ticks = np.array([19, 20, 29, 30, 46, 49, 50, 51, 60, 61])
    drawn = series.curve_by_world(series.population, [fork, other], ticks)
    unknown = np.nan
    np.testing.assert_array_equal(
        drawn,
        [
            [unknown, 2, 2, 2, 1, 1, 1, unknown, unknown, unknown],
            [unknown, unknown, unknown, 1, 1, 1, 1, 1, 1, unknown],
        ],
    )
