"""The pace: which speed comes next, how long it waits, and how long the next chunk is."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from primordia.live import pace as paces
from primordia.live.pace import NAP, Pace
from primordia.random.wide import wide
from primordia.runs.loop import Status


class Clock:
    """Seconds that pass only while something waits; it notes the waits."""

    def __init__(self) -> None:
        self.now, self.waits = 0.0, list[float]()

    def perf_counter(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.waits.append(seconds)
        self.now += seconds


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    monkeypatch.setattr(paces, "time", clock := Clock())
    return clock


def at(tick: int) -> Status:
    """Return the status of a run whose first world is at a tick, and whose second has stopped."""
    engine: Any = SimpleNamespace(longest=-1)
    world = SimpleNamespace(worlds=SimpleNamespace(tick=wide(np.array([tick, 3]))))
    engine.state = SimpleNamespace(world=world)
    return Status(engine, 0.0)


@pytest.mark.parametrize(
    ("limit", "speed", "slower"),
    [
        (None, None, 3000),  # an unknown speed counts as 10,000
        (None, 5000.0, 3000),
        (None, 3000.0, 1000),  # lower than the present speed, not equal to it
        (None, 1.0, None),
        (3000, 500.0, 1000),  # the run keeps to its limit, whatever its speed was before
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
    assert pace.limit == 100, "at its new limit it is not late"


def test_a_run_that_was_late_does_not_catch_up(clock: Clock) -> None:
    """The limit is 10 ticks a second; the first 10 ticks take 5 s in place of 1."""
    pace = Pace(10)
    pace(at(0), clock.sleep)
    clock.now += 5.0
    pace(at(10), clock.sleep)
    for tick in range(11, 16):
        pace(at(tick), clock.sleep)
    assert clock.now == pytest.approx(5.5)
    pace.faster()
    assert pace.limit == 30, "it is no longer late"


def test_a_delay_of_less_than_a_tenth_of_a_second_is_made_up(clock: Clock) -> None:
    """The first tick takes 0.15 s in place of 0.1, and the second ends in time."""
    pace = Pace(10)
    pace(at(0), clock.sleep)
    clock.now += 0.15
    pace(at(1), clock.sleep)
    pace(at(2), clock.sleep)
    assert clock.now == pytest.approx(0.2)


def test_a_wait_is_cut_into_naps(clock: Clock) -> None:
    pace = Pace(1)
    pace(at(0), clock.sleep)
    pace(at(1), clock.sleep)
    assert clock.waits == [NAP] * 4
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
    assert waits == [NAP] * 3, "it waits until the pause ends"
    assert (status.engine.longest, str(pace)) == (None, "")


def test_steps_that_were_not_lived_are_forgotten_with_the_pause(clock: Clock) -> None:
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
    """Neither as time in which the run was late, nor as time to catch up."""
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


def test_a_pace_is_told_in_a_few_words() -> None:
    assert [str(Pace(limit)) for limit in (None, 0.5, 3000, 1e8)] == [
        "", "at most 0.5 ticks/s", "at most 3,000 ticks/s", "at most 1e+08 ticks/s",
    ]  # fmt: skip
    pace = Pace(3)
    pace.pause()
    assert (str(pace), pace.limited) == ("paused", True)
    pace.pause()
    assert (str(pace), pace.limited, Pace().limited) == ("at most 3 ticks/s", True, False)
