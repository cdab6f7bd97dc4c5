"""Ticks lived for each death: compared with counting, and in runs that never saturate."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from primordia.comparison.pace import LATE, WINDOWS, pace
from tests.synthetic import LIVED, alive, world_of

TICKS = 7
"""ticks of a window"""


@given(LIVED, LIVED, st.integers(0, 20))
def test_every_tick_and_every_death_counts_once(
    one: list[tuple[int, int, bool]], other: list[tuple[int, int, bool]], since: int
) -> None:
    worlds = [world_of(lived, until=110) for lived in (one, other)]
    measured = pace(
        [world.recorded_since(since) for world in worlds], since, since + WINDOWS * TICKS
    )
    for number, world in enumerate(worlds):
        for window in range(WINDOWS):
            ticks = range(since + window * TICKS, since + (window + 1) * TICKS)
            lived = sum(alive(world, row, tick) for row in range(len(world)) for tick in ticks)
            ended = world.ended[world.died] - 1
            assert measured.lived[number, window] == lived
            assert measured.deaths[number, window] == np.isin(ended, ticks).sum()
    late = measured.lived[:, -LATE:].sum(1), measured.deaths[:, -LATE:].sum(1)
    assert (measured.late.known == (late[1] > 0)).all()
    assert (measured.late.value == late[0] / np.maximum(late[1], 1)).all()
    assert (measured.curve == measured.lived / np.maximum(measured.deaths, 1)).all()
