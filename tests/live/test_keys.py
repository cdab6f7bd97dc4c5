"""Keys of the live view: they change what is seen and how fast, and nothing that is lived."""

import os
import sys
import termios
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest

import primordia
from primordia import interrupts
from primordia.live.terminal import Keyboard, show_cursor
from primordia.live.view import View
from primordia.live.watching import watching
from primordia.runs import loop
from tests.live import posed
from tests.live.terminals import SETTINGS, Terminal, opened
from tests.trouble import SMALL
from tests.worlds import HERD, config

# In a terminal.


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    with opened() as terminal:
        yield terminal


@pytest.mark.slow  # the tests below do the same without a process
def test_keys_pause_step_and_stop_and_the_terminal_is_given_back(
    terminal: Terminal, tmp_path: Path
) -> None:
    before, run = terminal.modes(), tmp_path / "run"
    words = "run", *SMALL[:-1], "--until", "none", "--speed", "5", "--out", run
    process = terminal.begin(*words)
    terminal.read_until("\x1b[?25l", "line of descent", "quit", "at most 5 ticks/s")
    assert terminal.modes() != before
    terminal.press(b" ")
    ticks = [terminal.read_until(pattern=r"paused.*?tick +([\d,]+) ")]
    for _ in range(2):
        terminal.press(b"s")
        ticks.append(terminal.read_until(pattern=rf"tick +(?!{ticks[-1]} )([\d,]+) "))
    counts = [int(tick.replace(",", "")) for tick in ticks]
    assert np.diff(counts).tolist() == [1, 1]
    terminal.press(b"?")
    terminal.read_until("Live one tick, and pause.")
    terminal.press(b"\x03")
    written = terminal.read_until("\x1b[?25h", "Stopped and saved. Go on with: primordia resume")
    assert "\x1b[?25l" not in written, "the cursor stays"
    assert process.wait(timeout=60) == 130
    assert terminal.modes() == before


@pytest.fixture
def keyboard(terminal: Terminal, monkeypatch: pytest.MonkeyPatch) -> Iterator[type[Keyboard]]:
    with open(os.ttyname(terminal.theirs)) as stdin:
        monkeypatch.setattr(sys, "__stdin__", stdin)
        monkeypatch.setattr(Keyboard, "_in_front", lambda _: True)
        yield Keyboard


def test_a_run_takes_a_terminal_and_gives_it_back(
    terminal: Terminal, keyboard: type[Keyboard], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C remains a signal, before whose end the cursor is shown and the terminal is restored."""
    before, undone = terminal.modes(), list(interrupts._undo)
    for name in ("NO_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", SETTINGS["TERM"])
    with open(os.ttyname(terminal.theirs), "w") as screen:
        for name in ("stdout", "__stdout__"):
            monkeypatch.setattr(sys, name, screen)
        with watching(quiet=False, speed=5.0) as view:
            assert isinstance(view, View)
            assert view._pace.limit == 5
            assert view._keyboard.there
            modes = terminal.modes()[3]
            assert modes & (termios.ISIG | termios.ECHO | termios.ICANON) == termios.ISIG
            cursor, restore = interrupts._undo[len(undone) :]
            restore()
            assert terminal.modes() == before
            terminal.read_until("\x1b[?25l")
            assert cursor is show_cursor
    assert terminal.modes() == before
    assert interrupts._undo == undone
    assert "\x1b[?25l" not in terminal.read_until("\x1b[?25h"), "the cursor stays"


@pytest.fixture
def waits(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Return a list that gets the seconds of each wait without a terminal; no time passes."""
    seconds: list[float] = []
    monkeypatch.setattr("primordia.live.terminal.time", SimpleNamespace(sleep=seconds.append))
    return seconds


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


@pytest.mark.parametrize("begins_in_front", [False, True])
def test_a_command_in_the_background_leaves_the_terminal_to_the_shell(
    begins_in_front: bool,
    terminal: Terminal,
    keyboard: type[Keyboard],
    waits: list[float],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The command still waits. It ends without a change of the terminal's modes."""
    before = terminal.modes()
    monkeypatch.setattr(Keyboard, "_in_front", lambda _: begins_in_front)
    with keyboard() as keys:
        taken = terminal.modes()
        assert (taken != before) == begins_in_front
        monkeypatch.setattr(Keyboard, "_in_front", lambda _: False)
        terminal.press(b"abc\n")
        assert [keys.pressed(seconds) for seconds in (0.25, 0.0, 0.125)] == ["", "", ""]
        assert waits == [0.25, 0.125]
        assert keys.there
    assert terminal.modes() == taken


def test_a_terminal_that_is_gone_has_no_more_keys(
    keyboard: type[Keyboard], waits: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A read from such a terminal ends at once. So later waits for keys do not read from it."""
    monkeypatch.setattr("select.select", lambda *_: ([1], [], []))
    for gone in (MagicMock(return_value=b""), MagicMock(side_effect=OSError)):
        with keyboard() as keys:
            monkeypatch.setattr("os.read", gone)
            assert keys.pressed(5.0) == ""
            assert not keys.there
            assert keys.pressed(0.5) == ""
        gone.assert_called_once()
    assert waits == [0.5, 0.5]


def test_without_a_terminal_there_are_no_keys(monkeypatch: pytest.MonkeyPatch) -> None:
    with open(os.devnull) as nothing:
        for stdin in (None, nothing):
            monkeypatch.setattr(sys, "__stdin__", stdin)
            with Keyboard() as keys:
                assert not keys.there
                assert keys.pressed(0.0) == ""


# Nothing that is lived.


def watch(keys: str, run: Path) -> list[str]:
    """Live a small run while keys are pressed -> the digest of each world."""
    with View(posed.terminal(100, 30), keyboard=posed.Pressed(keys)) as view:
        loop.start(config(HERD, stop={"ticks": 400}), run, listen=view)
    return digests(run)


def digests(run: Path) -> list[str]:
    return [world["digest"] for world in primordia.load(run).info()["worlds"]]


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Return the digests of the run if no key is pressed."""
    return watch("", tmp_path_factory.mktemp("keys") / "none")


def test_a_run_is_the_same_whatever_keys_are_pressed(
    undisturbed: list[str], tmp_path: Path
) -> None:
    assert watch("o n n ws s s -+ w ? ? on s w o =++", tmp_path / "keys") == undisturbed


def test_q_writes_a_checkpoint_from_which_the_run_goes_on(
    undisturbed: list[str], tmp_path: Path
) -> None:
    with pytest.raises(KeyboardInterrupt):
        watch(" ssq", tmp_path / "keys")
    loop.resume(tmp_path / "keys")
    assert digests(tmp_path / "keys") == undisturbed
