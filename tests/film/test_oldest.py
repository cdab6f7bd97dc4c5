"""The oldest organism so far, and how long its life is shown."""

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from primordia.film.oldest import oldest_so_far, shown
from primordia.runs.lives import Lives
from tests.synthetic import LIVED, world_of


def check_oldest(world: Lives, ticks: np.ndarray) -> None:
    """Check that the oldest so far has the greatest age by then.

    Among equal ages the living come before the dead, and these in the order of their deaths.
    """
    for tick, row in zip(ticks, oldest_so_far(world, ticks), strict=True):
        ages = np.where(world.born <= tick, np.minimum(world.ended, tick) - world.born, -1)
        death = np.where(world.died & (world.ended <= tick), world.ended, 0)
        assert row == np.lexsort((death, -ages))[0]


@given(LIVED, st.lists(st.integers(0, 60), min_size=1, max_size=8))
def test_the_oldest_so_far_has_the_greatest_age_by_then(
    lived: list[tuple[int, int, bool]], later: list[int]
) -> None:
    world = world_of(lived)
    check_oldest(world, int(world.born.min()) + np.sort(later))


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
    """Each of 100 lives occurs twice."""
    spans = np.random.default_rng(2).integers(100, 400, 100)
    lived = [(born, int(span), True) for born, span in enumerate(spans)] * 2
    check_oldest(world_of(lived, until=999), np.arange(0, 520))
