"""Numbers in figures equal those counted tick by tick and life by life."""

from itertools import pairwise

import numpy as np
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


@given(last=st.integers(0, 10**7))
def test_bins_start_at_0_rise_and_end_with_the_last_tick(last: int) -> None:
    edges = series.bins(last)
    assert edges[0] == 0
    assert edges[-1] == max(last, 1)
    assert (np.diff(edges) > 0).all()
    assert (np.diff(series.middle(edges)) > 0).all()
