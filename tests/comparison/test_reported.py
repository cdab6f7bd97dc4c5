"""Reported numbers at the borders: of ages, ticks, shares and draws."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.comparison.measured import Measured
from primordia.comparison.moments import first_long, often_saturated
from primordia.comparison.survival import survival
from tests.synthetic import LIVED, world_of, worlds_of

Lived = list[tuple[int, int, bool]]
UNTIL = 90
"""a tick later than all births and deaths of LIVED"""


@given(LIVED, LIVED, st.integers(0, 60))
def test_at_risk_are_those_on_record_at_an_age(one: Lived, other: Lived, begin: int) -> None:
    """Organisms of a fork come on record at different ages."""
    lives = worlds_of(one, other, until=UNTIL).recorded_since(begin)
    estimate = survival(lives, 2, 50)
    for world in range(2):
        lived = lives.of_world(world)
        at_risk = [((lived.entered < age) & (age <= lived.lifespan)).sum() for age in estimate.ages]
        assert estimate.at_risk[world].tolist() == at_risk


@given(LIVED, LIVED, st.integers(1, 45))
def test_the_first_long_life_is_known_when_no_earlier_one_can_become_long(
    one: Lived, other: Lived, age: int
) -> None:
    worlds = [world_of(lived, until=41) for lived in (one, other)]
    measured = first_long(worlds, age)
    for number, world in enumerate(worlds):
        long = (world.lifespan >= age).tolist()
        may_be = (~world.died | (world.lifespan >= age)).tolist()
        first = may_be.index(True) if True in may_be else len(world)
        assert measured.value[number] == first + 1
        assert measured.known[number] == (first < len(world) and long[first])


def test_births_to_the_first_long_life_of_a_fork_are_those_since_the_fork() -> None:
    """Two of three organisms alive at the fork in tick 10 live long. So does the third born later."""
    lived = [(0, 60, True), (2, 50, True), (10, 3, True)]
    lived += [(12, 3, True), (14, 4, True), (15, 40, True)]
    world = world_of(lived, until=UNTIL).recorded_since(10)
    assert world.inherited.tolist() == [True] * 3 + [False] * 3
    found = first_long([world, world.recorded_until(30), world.take(np.arange(3))], 20)
    assert (found.value.tolist(), found.known.tolist()) == ([3, 3, 1], [True, False, False])


@pytest.mark.parametrize("worlds", [1, 7, 8])
def test_worlds_saturate_often_if_at_least_half_of_them_do(worlds: int) -> None:
    for by_births in range(worlds + 1):
        for by_ticks in range(worlds + 1):
            counts = {"births": by_births, "ticks": by_ticks}
            measured = {
                name: Measured(np.ones(worlds), np.arange(worlds) < count)
                for name, count in counts.items()
            }
            assert often_saturated(measured) == (min(counts.values()) >= worlds / 2)


@given(st.lists(st.tuples(st.integers(1, 30), st.booleans()), min_size=1, max_size=15))
def test_bounds_of_quartiles_are_order_statistics(worlds: list[tuple[int, bool]]) -> None:
    value, known = (np.array(column) for column in zip(*worlds, strict=True))
    measured = Measured(value.astype(float), known)
    for q in (0.25, 0.5, 0.75):
        place = max(int(np.ceil(q * len(worlds))), 1) - 1
        low = sorted(value.tolist())[place]
        high = sorted(np.where(known, value, np.inf).tolist())[place]
        assert measured.quantile(q) == (low, high)
    quartiles = [measured.quantile(q)[0] for q in (0.25, 0.5, 0.75)]
    assert all(low <= high for low, high in pairwise(quartiles))
