"""The pace of a run: the next speed, the waits, and the length of the next chunk."""

from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.live import pace as paces
from primordia.live.pace import FRAME, NAP, Pace
from primordia.live.watching import watching
from primordia.random.wide import Wide, wide
from primordia.runs.loop import Listener, Status
from tests.live.posed import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    monkeypatch.setattr(paces, "time", clock := Clock())
    return clock


def at(tick: int) -> Status:
    """Return the status of a run whose second world is at a tick. The worlds beside it have stopped."""
    engine: Any = SimpleNamespace(longest=-1)
    world = SimpleNamespace(worlds=SimpleNamespace(tick=wide(np.array([3, tick, 9]))))
    engine.state = SimpleNamespace(world=world)
    return Status(engine, 0.0)


@pytest.mark.parametrize(
    ("limit", "speed", "slower"),
    [
        (None, None, 3000),  # an unknown speed counts as 10,000
        (None, 5000.0, 3000),
        (None, 3000.0, 1000),  # lower than the present speed, not equal to it
        (None, 1.0, None),
        (3000, 500.0, 1000),  # the measured speed does not count for a run that is not late
        (2000, None, 1000),
        (1, None, 1),
        (0.5, None, 0.5),
        (1e9, None, 3e8),
    ],
)
def test_slower_is_the_next_level_below(
    limit: float | None, speed: float | None, slower: float | None
) -> None:
    pace = Pace(limit)
    pace.slower(speed)
    assert pace.limit == slower


@pytest.mark.parametrize(
    ("limit", "faster"),
    [(None, None), (0.5, 1), (1, 3), (3, 10), (2000, 3000), (1e8, 3e8), (3e8, None), (1e9, None)],
)
def test_faster_is_the_next_level_above_or_no_limit(
    limit: float | None, faster: float | None
) -> None:
    pace = Pace(limit)
    pace.faster()
    assert pace.limit == faster


def test_a_run_that_cannot_keep_up_is_slowed_from_its_own_speed(clock: Clock) -> None:
    pace = Pace(3000)
    pace(at(0), clock.sleep)
    clock.now += 2.0
    pace(at(1000), clock.sleep)  # 500 ticks a second
    assert clock.waits == []
    pace.slower(500.0)
    assert pace.limit == 300
    pace.slower(500.0)
    assert pace.limit == 100, "the run is not late at its new limit"


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


def test_a_wait_is_cut_into_naps(clock: Clock) -> None:
    pace = Pace(1)
    pace(at(0), clock.sleep)
    pace(at(1), clock.sleep)
    assert clock.waits == pytest.approx([NAP] * 4)
    assert NAP == 0.25


@pytest.mark.parametrize(("limit", "longest"), [(None, None), (5, 1), (10, 1), (39, 3), (40, 4)])
def test_a_chunk_lasts_a_tenth_of_a_second_at_a_limited_speed(
    clock: Clock, limit: float | None, longest: int | None
) -> None:
    pace, status = Pace(limit), at(0)
    pace(status, clock.sleep)
    assert status.engine.longest == longest


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
    assert [str(Pace(limit)) for limit in (None, 0.5, 3000, 1e8)] == [
        "", "at most 0.5 ticks/s", "at most 3,000 ticks/s", "at most 1e+08 ticks/s",
    ]  # fmt: skip
    pace = Pace(3)
    pace.pause()
    assert (str(pace), pace.limited) == ("paused", True)
    pace.pause()
    assert (str(pace), pace.limited, Pace().limited) == ("at most 3 ticks/s", True, False)


def lived(listen: Listener, clock: Clock, capacity: float, seconds: float) -> tuple[int, float]:
    """Live at a pace on a machine of `capacity` ticks a second -> ticks, seconds."""
    engine: Any = SimpleNamespace(longest=None)
    tick, began = 0, clock.now
    while clock.now - began < seconds:
        ticks = min(engine.longest or 10**9, max(int(0.2 * capacity), 1))
        tick += ticks
        clock.now += ticks / capacity
        words = Wide(*np.array([[0, 0], [tick, 3]], np.uint32))
        worlds = SimpleNamespace(worlds=SimpleNamespace(tick=words))
        engine.state = SimpleNamespace(world=worlds)
        listen(Status(engine, clock.now))
    return tick, clock.now - began


@given(
    limit=st.floats(0.5, 1e5),
    capacity=st.floats(20.0, 1e6),
)
def test_no_more_ticks_a_second_than_the_limit(limit: float, capacity: float) -> None:
    clock = Clock()
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(paces, "time", clock)
        ticks, seconds = lived(partial(Pace(limit), react=clock.sleep), clock, capacity, 20.0)
        first = max(int(0.2 * capacity), 1)  # the first chunk knows no limit
        assert ticks - first <= limit * seconds + max(limit * FRAME, 1)
        assert ticks >= 0.8 * min(limit, capacity) * 20.0 - 1, "and hardly fewer"


@pytest.mark.parametrize("quiet", [True, False])
def test_a_limit_holds_also_where_nothing_is_drawn(
    quiet: bool, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A quiet run prints nothing; another prints plain lines, since its output is no terminal."""
    monkeypatch.setattr("primordia.live.watching.Plain._print", lambda *_: None)
    monkeypatch.setattr(Pace.__call__, "__defaults__", (clock.sleep,))
    with watching(quiet, 50.0) as listen:
        assert listen is not None
        ticks, seconds = lived(listen, clock, 1000.0, 20.0)
    assert 0.8 * 50 * seconds <= ticks <= 50 * seconds + 200


def test_a_quiet_run_without_a_speed_is_not_listened_to() -> None:
    with watching(quiet=True) as listen:
        assert listen is None


def test_a_run_that_cannot_keep_up_is_not_given_a_higher_limit(clock: Clock) -> None:
    """It lives 5 ticks a second, and its limit is 10."""
    pace = Pace(10)
    lived(partial(pace, react=clock.sleep), clock, 5.0, 10.0)
    pace.faster()
    assert pace.limit is None
