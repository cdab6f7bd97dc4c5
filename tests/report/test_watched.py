"""What a live page is told, and when its run is read again, without a server or a browser."""

import io
import json
import threading
from pathlib import Path
from threading import BoundedSemaphore
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, call

import pytest

from primordia.errors import InputError, Trouble
from primordia.report import watch as watching
from primordia.report import watched
from primordia.report.server import QUIET, Handler
from primordia.report.watched import Watched


class Runs:
    """Two runs whose checkpoints have numbers; the content of a page is the pair of these numbers."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.newest = {Path("one"): 0, Path("other"): 0}
        self.errors: list[Exception] = []
        run = SimpleNamespace(paths=(Path("one"), Path("other")))
        monkeypatch.setattr(
            watched, "newest_version", lambda path: ("checkpoint", self.newest[path])
        )
        monkeypatch.setattr(watched, "of_run", self._read)
        monkeypatch.setattr(
            "primordia.runs.directory.is_written", lambda path: path in self.written
        )
        self.written: set[Path] = set()
        self.watched = Watched(lambda: run)  # type: ignore[return-value]

    def _read(self, run: Any, filmed: bool) -> list[int]:
        assert not filmed, "films take too long"
        if self.errors:
            raise self.errors.pop()
        return list(self.newest.values())

    def shown(self) -> tuple[list[int], int]:
        """Return the content, and its number, after a look."""
        self.watched.look()
        state = json.loads(self.watched.news(None, 0.0))
        return json.loads(self.watched.data()), state["count"]


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> Runs:
    return Runs(monkeypatch)


@pytest.mark.parametrize("path", [Path("one"), Path("other")])
def test_a_new_checkpoint_of_any_of_several_runs_is_shown(path: Path, runs: Runs) -> None:
    assert runs.shown() == ([0, 0], 0)
    runs.newest[path] = 7
    content = list(runs.newest.values())
    assert runs.shown() == (content, 1)
    assert runs.shown() == (content, 1), "nothing is new"


@pytest.mark.parametrize("error", [InputError("x"), Trouble("x"), OSError()])
def test_a_checkpoint_that_could_not_be_read_is_read_at_the_next_look(
    error: Exception, runs: Runs
) -> None:
    runs.newest[Path("one")] = 1
    runs.errors.append(error)
    assert runs.shown() == ([0, 0], 0)
    assert runs.shown() == ([1, 0], 1)


def test_a_page_says_each_time_whether_a_process_writes_one_of_the_runs(runs: Runs) -> None:
    for written in (set(), {Path("one")}, {Path("other")}, set(), {Path("one"), Path("other")}):
        runs.written = written
        runs.watched.look()
        assert json.loads(runs.watched.news(None, 0.0)) == {"count": 0, "going": bool(written)}


def test_without_news_the_state_is_told_again_after_the_given_time(runs: Runs) -> None:
    told: list[str] = []
    state = runs.watched.news(None, 0.0)
    waiting = threading.Thread(
        target=lambda: told.append(runs.watched.news(state, 0.001)), daemon=True
    )
    waiting.start()
    waiting.join(20.0)
    assert told == [state]


def test_a_page_gets_each_new_state_once_and_an_empty_line_where_nothing_is_new() -> None:
    """The connection is closed after the sixth line."""
    states = ["a", "a", "b", "b", "b", "c"]
    news = MagicMock(side_effect=[*states, ConnectionResetError])
    server = SimpleNamespace(watched=SimpleNamespace(news=news))
    handler: Any = SimpleNamespace(server=server, wfile=io.BytesIO())
    with pytest.raises(ConnectionResetError):
        Handler._tell(handler)
    lines = handler.wfile.getvalue().decode().split("\n\n")
    assert lines == ["data: a", ": ", "data: b", ": ", ": ", "data: c", ""]
    assert news.call_args_list == [call(told, QUIET) for told in (None, *states)]


def test_a_page_that_is_closed_makes_room_for_another() -> None:
    listeners = BoundedSemaphore(1)
    handler: Any = MagicMock(server=SimpleNamespace(listeners=listeners), command="GET")
    for _ in range(3):
        handler._tell.side_effect = BrokenPipeError
        Handler._events(handler)
    assert handler._tell.call_count == 3
    handler._refuse.assert_not_called()


def test_the_run_is_no_longer_read_when_the_server_has_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    content, server, begun = MagicMock(), MagicMock(), MagicMock()
    server.return_value.__enter__.return_value.serve_forever.side_effect = KeyboardInterrupt
    monkeypatch.setattr(watching, "Watched", lambda open_: content)
    monkeypatch.setattr(watching, "Server", server)
    with pytest.raises(KeyboardInterrupt):
        watching.watch(MagicMock(), 7, begun)
    server.assert_called_once_with(content, 7)
    begun.assert_called_once_with(server.return_value.__enter__.return_value.address)
    (ended,) = content.follow.call_args.args
    assert ended.is_set()
