"""The times at which the view draws, takes past moments, and prints plain lines."""

from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest

from primordia.live import view as views
from primordia.live import watching
from primordia.live.pace import Pace
from primordia.live.watching import Plain
from tests.live.posed import Clock, Pressed, status, view


class Frames:
    """A view whose frames take some seconds of a clock. It notes when each frame began."""

    def __init__(
        self, cost: float, monkeypatch: pytest.MonkeyPatch, keys: Iterable[str] = ""
    ) -> None:
        self.now, self.cost, self.began = 100.0, cost, list[float]()
        clock = SimpleNamespace(perf_counter=lambda: self.now, sleep=lambda _: None)
        monkeypatch.setattr(views, "time", clock)
        self.view = view(keyboard=Pressed(keys))
        self.view._live = SimpleNamespace(update=self._update)
        self.view._rows = lambda _: []
        self.view._pace = lambda *_: None
        self.view._pace.limited = False
        self.moments: list[tuple[float, int]] = []
        self.view._stage.follow = lambda *values: self.moments.append((self.now, values[3]))

    def _update(self, *_: Any, **__: Any) -> None:
        self.began.append(self.now)
        self.now += self.cost

    def live(self, seconds: float, each: float, worlds: int = 1) -> None:
        """Give the view chunks of `each` seconds until some seconds have passed."""
        until, of = self.now + seconds, status(worlds)
        while self.now < until:
            self.view(of)
            self.now += each


@pytest.mark.parametrize(("cost", "between"), [(0.004, 0.4), (0.015, 1.5), (0.02, 2.0), (0.5, 2.0)])
def test_a_frame_is_drawn_after_a_hundred_times_its_cost_and_at_least_every_two_seconds(
    cost: float, between: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    frames = Frames(cost, monkeypatch)
    frames.live(8.0, 0.05)
    np.testing.assert_allclose(np.diff(frames.began), between + cost, atol=0.0501)


def test_a_past_moment_of_a_world_alone_is_taken_every_tenth_of_a_second(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    frames = Frames(0.0, monkeypatch)
    frames.live(1.0, 0.03)
    np.testing.assert_allclose(np.diff([at for at, _ in frames.moments]), 0.12)
    frames.moments.clear()
    frames.live(1.0, 0.03, worlds=3)
    assert frames.moments == [], "several worlds side by side have no past"
    for alone in (0, 2):
        frames.view._alone = alone
        frames.live(1.0, 0.03, worlds=3)
        assert {world for _, world in frames.moments} == {alone}
        frames.moments.clear()
    frames.view._pace.limited = True
    frames.live(1.0, 0.03)
    np.testing.assert_allclose(np.diff([at for at, _ in frames.moments]), 0.03)


def test_a_waiting_run_draws_a_state_that_is_not_drawn_yet(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    frames = Frames(0.0625, monkeypatch)
    frames.view(status(1))
    frames.view(status(1))
    assert len(frames.began) == 1
    frames.view._react(0.0625)
    assert len(frames.began) == 1, "the wait is as short as a frame"
    frames.view._react(0.07)
    frames.view._react(0.07)
    assert len(frames.began) == 2, "a state is drawn once"


def test_a_key_and_a_new_size_cause_a_frame_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = Frames(0.05, monkeypatch, keys=["", "", "w?", ""])
    cleared: list[int] = []
    frames.view._console.clear = lambda: cleared.append(len(frames.began))
    frames.view(status(3))
    assert len(frames.began) == 1
    frames.view._console.size = frames.view._console.size._replace(width=50)
    frames.view._react(0.0)
    assert len(frames.began) == 2
    frames.view._react(0.0)
    assert (len(frames.began), frames.view._alone, frames.view._page) == (3, 0, 0)
    frames.view._react(0.0)
    assert len(frames.began) == 3
    assert cleared == [1], "the second frame is drawn on an empty screen"


def test_before_the_first_chunk_the_view_says_that_it_compiles() -> None:
    """A view that ends before the first chunk removes these words."""
    shown = view()
    with shown:
        assert "Compiling, which takes some seconds" in shown._console.file.getvalue()
        shown._live.update = update = MagicMock()
    update.assert_called_once_with("")


@pytest.mark.parametrize(
    ("terminal", "dumb", "grey", "drawn"),
    [(False, False, False, False), (True, True, False, False),
     (True, False, True, False), (True, False, False, True)],
)  # fmt: skip
def test_a_view_is_drawn_in_a_terminal_with_colours_that_can_move_its_cursor(
    terminal: bool, dumb: bool, grey: bool, drawn: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Otherwise, plain lines are printed."""
    made, keyboard = MagicMock(), MagicMock()
    keyboard.return_value.__enter__.return_value = keyboard
    console = SimpleNamespace(is_dumb_terminal=dumb, no_color=grey)
    monkeypatch.setattr(watching, "Console", lambda **_: console)
    monkeypatch.setattr(watching, "Keyboard", keyboard)
    monkeypatch.setattr(watching, "View", made)
    monkeypatch.setattr("sys.stdout", SimpleNamespace(isatty=lambda: terminal))
    with watching.watching(False, 50.0) as listen:
        assert isinstance(listen, Plain) is not drawn
        assert drawn or listen._pace.limit == 50.0
    assert made.call_count == drawn
    for shown in made.call_args_list:
        of, pace, given = shown.args
        assert (of, pace.limit, given) == (console, 50.0, keyboard)


def test_a_quiet_run_has_a_pace_if_its_speed_is_limited() -> None:
    with watching.watching(True, 50.0) as pace, watching.watching(True) as none:
        assert isinstance(pace, Pace)
        assert (pace.limit, none) == (50.0, None)


def test_a_plain_line_has_the_counts_of_all_worlds_every_two_seconds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """No line follows the first chunk. From 10 to 12 s, three worlds live 1,000 organism-ticks each."""
    monkeypatch.setattr(watching, "time", clock := Clock())
    paced: list[Any] = []
    plain = Plain(lambda of: paced.append(of))
    for now, lived, tick in (
        (10.0, 0, 9),
        (11.9, 900, 50),
        (12.0, 1000, 1234),
        (13.9, 1, 1),
        (14.0, 1600, 1500),
        (16.0, 1600, 1500),
    ):
        clock.now = now
        plain(status(3, tick, births=[1000, 20, 3], organism_ticks=[lived, lived, lived]))
    assert len(paced) == 6, "the pace holds whether or not a line is printed"
    assert capsys.readouterr().out.splitlines() == [
        "  75.0 s  tick 1,234  alive 6  births 1,023  1.5 k organism-ticks/s",
        "  75.0 s  tick 1,500  alive 6  births 1,023  900 organism-ticks/s",
        "  75.0 s  tick 1,500  alive 6  births 1,023  0 organism-ticks/s",
    ]
