"""The oldest organism so far, and how long its life is shown."""

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from primordia.film.oldest import oldest_so_far, shown
from tests.synthetic import LIVED, world_of


@given(LIVED, st.lists(st.integers(0, 60), min_size=1, max_size=8))
def test_the_oldest_so_far_has_the_greatest_age_by_then(
    lived: list[tuple[int, int, bool]], later: list[int]
) -> None:
    world = world_of(lived)
    ticks = int(world.born.min()) + np.sort(later)
    found = oldest_so_far(world, ticks)
    for tick, row in zip(ticks, found, strict=True):
        ages = np.where(world.born <= tick, np.minimum(world.ended, tick) - world.born, -1)
        assert ages[row] == ages.max()


def test_among_equal_ages_the_living_come_before_the_dead_and_the_first_before_later_ones() -> None:
    """The first three live 10 ticks each. The last one reaches this age at tick 40, after their
    deaths."""
    world = world_of([(0, 9, True), (5, 9, True), (8, 9, True), (30, 60, False)], until=90)
    found = oldest_so_far(world, np.array([9, 10, 15, 18, 39, 40, 41]))
    assert found.tolist() == [0, 0, 0, 0, 0, 3, 3]


@given(st.lists(st.integers(0, 2), min_size=1, max_size=40), st.integers(1, 6))
def test_each_life_is_shown_for_a_while_and_then_the_oldest_of_that_moment(
    holders: list[int], least: int
) -> None:
    seen = shown(np.array(holders), least)
    begins = [0, *(np.flatnonzero(np.diff(seen)) + 1)]
    assert [seen[at] for at in begins] == [holders[at] for at in begins]
    assert all(later - at >= least for at, later in pairwise(begins))
    for now in range(len(seen)):
        since = max(at for at in begins if at <= now)
        assert seen[now] == holders[now] or now - since < least


def test_among_many_lives_the_first_of_equal_ages_is_the_oldest() -> None:
    """Each of 100 lives occurs twice. Among equal ages, the living come first, then the first death."""
    spans = np.random.default_rng(2).integers(100, 400, 100)
    world = world_of([(born, int(span), True) for born, span in enumerate(spans)] * 2, until=999)
    ticks = np.arange(0, 520)
    for tick, row in zip(ticks, oldest_so_far(world, ticks), strict=True):
        ages = np.where(world.born <= tick, np.minimum(world.ended, tick) - world.born, -1)
        dead = np.where(world.ended <= tick, world.ended, 0)
        assert row == np.lexsort((dead, -ages))[0]
