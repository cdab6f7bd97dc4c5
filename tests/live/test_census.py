"""The counts of a run and its speed, from worlds that differ in every count."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.engine.state import Limits
from primordia.law.world import Cause
from primordia.live.census import Census, Speed
from primordia.random.wide import wide
from tests.live.posed import counted, posed

LONG = 2**33 + 7
COUNTS: dict[str, list[Any]] = {
    "tick": [100, 70, LONG],
    "births": [11, 5, 2**40],
    "deaths": [[8, 0, 0, 0, 0, 0, 1], [1, 2, 3, 4, 5, 6, 7], [2**39, 0, 9, 0, 0, 0, 0]],
    "extinctions": [0, 2, 1],
    "organism_ticks": [400, 90, 2**50],
    "calm": [3, 0, 50],
    "saturated": [-1, 60, 2**33],
}
"""Counts of three worlds. In the first, organisms of 5, 5 and 60 ticks live; in the second none; in the
third one. The oldest cells are empty, and more than 32 bits are needed."""
WORLD = posed(
    [[1, 1, 0, 1], [0, 0, 0, 0], [0, 0, 1, 0]],
    [[95, 95, 0, 40], [1, 2, 3, 4], [0, 1, 2**33 + 2, 0]],
    COUNTS["tick"],
    **{name: value for name, value in COUNTS.items() if name != "tick"},
)
AGES: dict[int | None, list[int]] = {
    None: [5, 5, 60, 5],
    0: [5, 5, 60],
    1: [],
    2: [5],
}


@pytest.mark.parametrize("alone", AGES)
def test_a_census_has_the_counts_of_all_worlds_or_of_one(alone: int | None) -> None:
    found, ages = Census.of(WORLD, alone), AGES[alone]
    for name, values in {**COUNTS, "alive": [3, 0, 1]}.items():
        expected = values if alone is None else [values[alone]]
        assert getattr(found, name).tolist() == expected, name
    assert found.deaths.shape == (len(found.tick), len(Cause))
    assert found.mean_age == (sum(ages) / len(ages) if ages else 0.0)
    assert found.oldest == max(ages, default=0)


def test_a_speed_is_that_since_the_latest_census_of_at_least_two_seconds_ago() -> None:
    speed = Speed()
    seen = [(0.0, 0), (1.0, 10), (2.0, 30), (3.0, 70), (3.5, 80), (10.0, 340), (10.5, 341)]
    since = [None, 0, 0, 1, 1, 4, 4]
    for (now, lived), first in zip(seen, since, strict=True):
        speed.add(now, counted(2, tick=[lived, 2 * lived], organism_ticks=[lived, 9 * lived]))
        if first is None:
            assert speed.organism_ticks_per_s() is speed.ticks_per_s() is None
            continue
        then, before = seen[first]
        rate = (lived - before) / (now - then)
        assert speed.organism_ticks_per_s() == pytest.approx(10 * rate)
        assert speed.ticks_per_s() == pytest.approx(2 * rate), "of the fastest world"


@pytest.mark.parametrize(
    ("ticks", "births", "left"),
    [
        ([100, 100], [7, 7], None),  # nothing moves
        ([500, 150], [7, 7], 14.0),  # the first is at its limit, the second needs 350 more, 25 a second
        ([700, 150], [7, 7], 14.0),  # the first is beyond its limit, as after a limit was lowered
        ([500, 500], [7, 7], 0.0),
        ([700, 600], [7, 7], 0.0),
        ([500, 100], [7, 7], None),  # the second will never come to a limit
        ([500, 100], [7, 9], 1.0),  # but it has births: 1 a second, and another one to go
        ([500, 100], [7, 12], 0.0),
    ],
)  # fmt: skip
def test_worlds_at_a_limit_or_at_a_standstill_have_no_time_left_or_an_unknown_one(
    ticks: list[int], births: list[int], left: float | None
) -> None:
    """Two worlds were at 100 ticks and 7 births two seconds ago; limits are 500 ticks and 10 births."""
    speed = Speed()
    speed.add(8.0, counted(2, tick=[100, 100], births=[7, 7]))
    speed.add(10.0, counted(2, tick=ticks, births=births))
    limits = Limits(wide([500] * 2), wide([10] * 2), jnp.bool_(False))
    assert speed.seconds_left(limits) == left


def test_a_world_that_has_stopped_has_no_time_left() -> None:
    """The first world was at its limit before; the second needs 350 ticks more, 25 a second."""
    speed = Speed()
    speed.add(8.0, counted(2, tick=[500, 100]))
    speed.add(10.0, counted(2, tick=[500, 150]))
    never = np.full(2, 2**64 - 1, np.uint64)
    assert speed.seconds_left(Limits(wide([500] * 2), wide(never), jnp.bool_(False))) == 14.0


def test_an_unknown_number_of_ticks_is_not_a_limit() -> None:
    speed = Speed()
    speed.add(0.0, counted(1, tick=[0], births=[0]))
    speed.add(2.0, counted(1, tick=[10], births=[4]))
    never = np.array([2**64 - 1], np.uint64)
    limits = [
        Limits(wide(t), wide(b), jnp.bool_(False)) for t, b in ((never, [10]), (never, never))
    ]
    assert [speed.seconds_left(each) for each in limits] == [3.0, None]
