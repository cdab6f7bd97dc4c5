"""Keys of the live view: they change what is seen and how fast, and nothing that is lived."""

import io
import os
import signal
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

import primordia
from primordia.live import pace as paces
from primordia.live.pace import FRAME, LEVELS, Pace
from primordia.live.terminal import Keyboard
from primordia.live.view import View
from primordia.live.watching import watching
from primordia.random.wide import Wide
from primordia.runs import loop
from primordia.runs.loop import Listener, Status
from tests.live.terminals import Terminal, opened
from tests.worlds import MEADOW, config

# In a terminal.

SMALL = ("CartPole-survival", "--cells", "8", "--hazard", "0.002", "--until", "none")


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    with opened() as terminal:
        yield terminal


def test_keys_pause_step_and_quit_and_the_terminal_is_given_back(
    terminal: Terminal, tmp_path: Path
) -> None:
    before, run = terminal.modes(), tmp_path / "run"
    process = terminal.begin("run", *SMALL, "--out", run)
    terminal.read_until("\x1b[?25l", "line of descent", "quit")
    assert terminal.modes() != before
    terminal.press(b" ")
    ticks = [terminal.read_match(r"paused.*?tick +([\d,]+) ")]
    for _ in range(2):
        terminal.press(b"s")
        ticks.append(terminal.read_match(rf"tick +(?!{ticks[-1]} )([\d,]+) "))
    counts = [int(tick.replace(",", "")) for tick in ticks]
    assert np.diff(counts).tolist() == [1, 1]
    terminal.press(b"?")
    terminal.read_until("Live one tick, and pause.")
    terminal.press(b"q")
    written = terminal.read_until("\x1b[?25h", "Stopped and saved. Go on with: primordia resume")
    assert "\x1b[?25l" not in written, "the cursor stays"
    assert process.wait(timeout=60) == 130
    assert terminal.modes() == before

    process = terminal.begin("resume", run, "--speed", "5")
    terminal.read_until("at most 5 ticks/s")
    terminal.press(b" ")
    terminal.read_until("paused")
    process.send_signal(signal.SIGTERM)
    terminal.read_until("\x1b[?25h", "Stopped and saved")
    assert process.wait(timeout=60) == 130
    assert terminal.modes() == before


@pytest.fixture
def keyboard(terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> Iterator[type[Keyboard]]:
    with open(os.ttyname(terminal.theirs)) as stdin:
        monkeypatch.setattr(sys, "__stdin__", stdin)
        monkeypatch.setattr(Keyboard, "_in_front", lambda _: True)
        yield Keyboard


def test_an_error_gives_the_terminal_back(terminal: Terminal, keyboard: type[Keyboard]) -> None:
    before = terminal.modes()

    def fail() -> None:
        with keyboard() as keys:
            assert terminal.modes() != before
            terminal.press(b"a\x1b[Ab\x1bOCc")
            assert keys.pressed(10.0) == "abc", "arrows mean nothing"
            assert keys.pressed(0.0) == ""
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert terminal.modes() == before


def test_a_shell_that_has_changed_the_terminal_is_followed(
    terminal: Terminal, keyboard: type[Keyboard]
) -> None:
    with keyboard() as keys:
        taken = terminal.modes()
        keys.restore()
        assert terminal.modes() != taken
        keys.pressed(0.0)
        assert terminal.modes() == taken


def test_a_command_in_the_background_leaves_the_terminal_alone(
    terminal: Terminal, keyboard: type[Keyboard], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Keyboard, "_in_front", lambda _: False)
    before = terminal.modes()
    with keyboard() as keys:
        terminal.press(b"abc\n")
        assert keys.pressed(0.0) == ""
        assert terminal.modes() == before


def test_without_a_terminal_there_are_no_keys(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "__stdin__", None)
    with Keyboard() as keys:
        assert not keys.there
        assert keys.pressed(0.0) == ""


def test_keys_are_named_only_where_there_are_keys(terminal: Terminal, tmp_path: Path) -> None:
    """Standard input may be a file while the screen is a terminal."""
    process = terminal.begin("run", *SMALL, "--out", tmp_path / "run", keys=os.devnull)
    written = terminal.read_until("\x1b[?25l", "line of descent", "takeovers")
    assert "quit" not in written
    process.send_signal(signal.SIGINT)
    terminal.read_until("Stopped and saved.")
    assert process.wait(timeout=60) == 130


# Nothing that is lived.


class Pressed(Keyboard):
    """Keys that are pressed one at each look."""

    def __init__(self, keys: str) -> None:
        super().__init__()
        self._keys = iter(keys)

    def pressed(self, seconds: float) -> str:
        return next(self._keys, "")


def watch(keys: str, run: Path) -> list[str]:
    """Live a small run while keys are pressed -> the digest of each world."""
    # rich keeps the codes of a style for the first terminal that it meets, so all have the same colours
    colours: Any = {"force_terminal": True, "color_system": "truecolor"}
    console = Console(file=io.StringIO(), width=100, height=30, **colours)
    settings = {**MEADOW, "brain": {"hidden": 3}, "hazard": 0.05, "replication": 0.3, "seeds": 2}
    with View(console, Pace(), Pressed(keys)) as view:
        loop.start(config(settings, stop={"ticks": 400}), run, listen=view)
    return digests(run)


def digests(run: Path) -> list[str]:
    return [world["digest"] for world in primordia.load(run).info()["worlds"]]


KEYS = "o n n ws s s -+ w ? ? on s w o =++"


def test_a_run_is_the_same_whatever_keys_are_pressed(tmp_path: Path) -> None:
    assert watch(KEYS, tmp_path / "keys") == watch("", tmp_path / "none")


def test_q_writes_a_checkpoint_from_which_the_run_goes_on(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        watch(" ssq", tmp_path / "keys")
    loop.resume(tmp_path / "keys")
    assert digests(tmp_path / "keys") == watch("", tmp_path / "none")


# The pace.


class Clock:
    """Seconds that pass when something waits or lives."""

    def __init__(self) -> None:
        self.now = 0.0

    def perf_counter(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds + 1e-9


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


def test_slower_and_faster_go_through_levels(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(paces, "time", clock)
    pace = Pace()
    pace.slower(5000.0)
    assert pace.limit == 3000
    for _ in range(2 * len(LEVELS)):
        pace.slower(5000.0)
    assert pace.limit == 1
    pace.faster()
    pace.faster()
    assert pace.limit == 10
    lived(partial(pace, react=clock.sleep), clock, 5.0, 10.0)
    pace.faster()
    assert pace.limit is None, "a higher limit would make no difference"
    pace.faster()
    assert str(pace) == ""


@pytest.mark.parametrize("quiet", [True, False])
def test_a_speed_holds_also_where_nothing_is_drawn(
    quiet: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a quiet run, and of one that prints plain lines, since its output is no terminal."""
    clock = Clock()
    monkeypatch.setattr(paces, "time", clock)
    monkeypatch.setattr("primordia.live.watching.Plain._print", lambda *_: None)
    monkeypatch.setattr(Pace.__call__, "__defaults__", (clock.sleep,))
    with watching(quiet, 50.0) as listen:
        assert listen is not None
        ticks, seconds = lived(listen, clock, 1000.0, 20.0)
    assert 0.8 * 50 * seconds <= ticks <= 50 * seconds + 200


def test_a_quiet_run_without_a_speed_is_not_listened_to() -> None:
    with watching(quiet=True) as listen:
        assert listen is None
