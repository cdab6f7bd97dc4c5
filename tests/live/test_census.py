"""The counts of worlds that differ in every count, the speed of a run, and the time left."""

from typing import Any

import jax.numpy as jnp
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
"""Counts of three worlds; some need more than 32 bits."""
WORLD = posed(
    [[1, 1, 0, 1], [0, 0, 0, 0], [0, 0, 1, 0]],
    [[95, 95, 0, 40], [1, 2, 3, 4], [0, 1, 2**33 + 2, 0]],
    COUNTS["tick"],
    **{name: value for name, value in COUNTS.items() if name != "tick"},
)
"""Three organisms are alive in the first world, none in the second, and one in the third. The earliest
births are those of empty cells, which do not count."""
AGES: dict[int | None, list[int]] = {None: [5, 5, 60, 5], 0: [5, 5, 60], 1: [], 2: [5]}


@pytest.mark.parametrize("alone", AGES)
def test_a_census_has_the_counts_of_all_worlds_or_of_one(alone: int | None) -> None:
    found, ages = Census.of(WORLD, alone), AGES[alone]
    for name, values in {**COUNTS, "alive": [3, 0, 1]}.items():
        expected = values if alone is None else [values[alone]]
        assert getattr(found, name).tolist() == expected, name
    assert found.deaths.shape == (len(found.tick), len(Cause))
    assert found.mean_age == (sum(ages) / len(ages) if ages else 0.0)
    assert found.oldest == max(ages, default=0)


def test_a_speed_is_measured_since_the_latest_census_of_at_least_two_seconds_ago() -> None:
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
        assert speed.ticks_per_s() == pytest.approx(2 * rate), "that of the fastest world"


NEVER = 2**64 - 1


def seconds_left(
    before: Census, after: Census, ticks: int, births: int = NEVER, saturation: bool = False
) -> float | None:
    """Return the time left of two worlds whose counts became `after` in two seconds.

    The run stops at some ticks, at some births, or at saturation.
    """
    speed = Speed()
    speed.add(8.0, before)
    speed.add(10.0, after)
    return speed.seconds_left(Limits(wide([ticks] * 2), wide([births] * 2), jnp.bool_(saturation)))


@pytest.mark.parametrize(
    ("ticks", "births", "left"),
    [
        ([100, 100], [7, 7], None),  # nothing moves
        ([500, 150], [7, 7], 14.0),  # the first is at its limit, the second needs 350 more, 25 a second
        ([700, 150], [7, 7], 14.0),  # the first is beyond its limit, as after a limit was lowered
        ([500, 500], [7, 7], 0.0),
        ([500, 100], [7, 9], 1.0),  # the second has one birth a second, and needs one more
        ([150, 100], [7, 9], 14.0),  # the first needs longer than that
        ([500, 100], [7, 12], 0.0),
    ],
)  # fmt: skip
def test_time_left_is_that_of_the_world_that_stops_last(
    ticks: list[int], births: list[int], left: float | None
) -> None:
    """Two worlds were at 100 ticks and 7 births two seconds ago; limits are 500 ticks and 10 births."""
    before, after = (
        counted(2, tick=[100, 100], births=[7, 7]),
        counted(2, tick=ticks, births=births),
    )
    assert seconds_left(before, after, 500, 10) == left
    assert seconds_left(before, after, NEVER) is None


@pytest.mark.parametrize(
    ("saturated", "ends"), [([-1, -1], 8.0), ([0, -1], 3.0), ([-1, 50], 8.0), ([50, 60], 0.0)]
)
def test_a_saturated_world_has_time_left_unless_the_run_stops_at_saturation(
    saturated: list[int], ends: float
) -> None:
    """In 2 s the worlds lived 100 and 200 ticks of 500, so they need another 8 s and 3 s."""
    before, after = counted(2), counted(2, tick=[100, 200], saturated=saturated)
    assert seconds_left(before, after, 500, saturation=True) == ends
    assert seconds_left(before, after, 500) == 8.0
