"""The pace of a run: the next speed, the waits, and the length of the next chunk."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.live import pace as paces
from primordia.live.pace import FRAME, NAP, Pace
from primordia.random.wide import Wide
from primordia.runs.loop import Status
from tests.live.posed import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    monkeypatch.setattr(paces, "time", clock := Clock())
    return clock


def at(tick: int) -> Status:
    """Return the status of a run whose second world is at a tick. The worlds beside it have stopped."""
    engine: Any = SimpleNamespace(longest=-1)
    ticks = Wide(*np.array([[0, 0, 0], [3, tick, 9]], np.uint32))
    world = SimpleNamespace(worlds=SimpleNamespace(tick=ticks))
    engine.state = SimpleNamespace(world=world)
    return Status(engine, 0.0)


@pytest.mark.parametrize(
    ("limit", "speed", "slower", "faster"),
    [
        (None, None, 3000, None),  # an unknown speed counts as 10,000
        (None, 3000.0, 1000, None),  # lower than the present speed, not equal to it
        (None, 1.0, None, None),
        (3000, 500.0, 1000, 10_000),  # the measured speed does not count if the run is not late
        (0.5, None, 0.5, 1),
        (3e8, None, 1e8, None),
    ],
)
def test_slower_is_the_next_level_below_and_faster_the_next_above_or_no_limit(
    limit: float | None, speed: float | None, slower: float | None, faster: float | None
) -> None:
    one, other = Pace(limit), Pace(limit)
    one.slower(speed)
    other.faster()
    assert (one.limit, other.limit) == (slower, faster)


def test_a_run_that_cannot_keep_up_is_slowed_from_its_own_speed_and_gets_no_higher_limit(
    clock: Clock,
) -> None:
    """It lives 500 ticks a second."""
    paces = Pace(3000), Pace(3000)
    for tick, clock.now in ((0, 0.0), (1000, 2.0)):
        for pace in paces:
            pace(at(tick), clock.sleep)
    assert clock.waits == []
    paces[1].faster()
    assert paces[1].limit is None
    for limit in (300, 100):  # the run is not late at its new limit
        paces[0].slower(500.0)
        assert paces[0].limit == limit


@pytest.mark.parametrize(
    ("delay", "late", "last", "ends"),
    [
        (5.0, 10, 15, 5.5),  # ten ticks take 5 s in place of 1, and the next five take 0.5 s
        (0.15, 1, 2, 0.2),  # a tick takes 0.15 s in place of 0.1, and the next ends in time
    ],
)
def test_only_a_delay_of_less_than_a_tenth_of_a_second_is_made_up(
    delay: float, late: int, last: int, ends: float, clock: Clock
) -> None:
    """The limit is 10 ticks a second. The delay comes before tick `late`."""
    pace = Pace(10)
    pace(at(0), clock.sleep)
    clock.now += delay
    for tick in range(late, last + 1):
        pace(at(tick), clock.sleep)
    assert clock.now == pytest.approx(ends)
    pace.faster()
    assert pace.limit == 30, "the run is no longer late"


def test_a_chunk_lasts_a_tenth_of_a_second_at_a_limited_speed_and_a_wait_is_cut_into_naps(
    clock: Clock,
) -> None:
    for limit, longest in ((None, None), (5, 1), (39, 3), (40, 4)):
        status = at(0)
        Pace(limit)(status, clock.sleep)
        assert status.engine.longest == longest
    pace = Pace(1)
    for tick in (0, 1):
        pace(at(tick), clock.sleep)
    assert clock.waits == pytest.approx([0.25] * 4)


def test_each_step_is_a_tick_and_then_the_run_waits(clock: Clock) -> None:
    pace, status = Pace(), at(0)
    pace.step()
    pace.step()
    waits: list[float] = []

    def react(seconds: float) -> None:
        waits.append(seconds)
        if len(waits) == 3:
            pace.pause()

    for _ in range(2):
        pace(status, react)
        assert (status.engine.longest, waits, str(pace)) == (1, [], "paused")
    pace(status, react)
    assert waits == [NAP] * 3, "the run waits until the pause ends"
    assert (status.engine.longest, str(pace)) == (None, "")


def test_the_end_of_a_pause_cancels_steps_that_were_not_lived(clock: Clock) -> None:
    pace, waits = Pace(), list[float]()
    pace.step()
    pace.pause()
    assert not pace.paused
    pace.pause()

    def react(seconds: float) -> None:
        waits.append(seconds)
        pace.step()

    pace(at(0), react)
    assert waits == [NAP]


def test_the_time_of_a_pause_does_not_count(clock: Clock) -> None:
    """After a pause a run is not late, and it does not catch up."""
    pace = Pace(10)
    pace(at(0), clock.sleep)
    pace.pause()
    clock.now = 100.0
    pace.pause()
    for tick in range(1, 12):
        pace(at(tick), clock.sleep)
    assert clock.now == pytest.approx(101.0)
    pace.faster()
    assert pace.limit == 30


def test_a_signal_ends_every_wait(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("primordia.interrupts.came", lambda: True)
    pace = Pace()
    pace.pause()
    pace(at(0), clock.sleep)
    assert clock.waits == []


def test_a_pace_is_described_in_a_few_words() -> None:
    pace = Pace(3000)
    assert (str(pace), pace.limited) == ("at most 3,000 ticks/s", True)
    pace.pause()
    assert (str(pace), pace.limited) == ("paused", True)
    assert (str(Pace()), Pace().limited) == ("", False)


@given(limit=st.floats(0.5, 1e5), capacity=st.floats(20.0, 1e6))
def test_no_more_ticks_a_second_than_the_limit(limit: float, capacity: float) -> None:
    """The machine lives `capacity` ticks a second. The first chunk knows no limit."""
    clock, engine = Clock(), at(0).engine
    tick, first, engine.longest = 0, max(int(0.2 * capacity), 1), None
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(paces, "time", clock)
        pace = Pace(limit)
        while clock.now < 20.0:
            ticks = min(engine.longest or 10**9, first)
            tick += ticks
            clock.now += ticks / capacity
            engine.state = at(tick).engine.state
            pace(Status(engine, clock.now), clock.sleep)
        assert tick - first <= limit * clock.now + max(limit * FRAME, 1)
        assert tick >= 0.8 * min(limit, capacity) * 20.0 - 1, "and hardly fewer"
