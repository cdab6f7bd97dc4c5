"""The content and the state of a live page, and when its runs are read again."""

import json
import threading
from contextlib import ExitStack
from pathlib import Path
from queue import SimpleQueue
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import pytest

from primordia.errors import InputError, Trouble
from primordia.report import server as watching
from primordia.report import watched
from primordia.report.watched import Watched
from primordia.runs import directory


class Runs:
    """Two runs. The content of a page is the numbers of their newest checkpoints."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.newest = {Path("one"): 0, Path("other"): 0}
        self.unopened: list[Exception] = []
        self.errors: list[Exception] = []
        monkeypatch.setattr(
            watched, "newest_version", lambda path: ("checkpoint", self.newest[path])
        )
        monkeypatch.setattr(watched, "of_run", self._read)
        self.watched = Watched(self._open)

    def _open(self) -> Any:
        if self.unopened:
            raise self.unopened.pop()
        return SimpleNamespace(paths=(Path("one"), Path("other")))

    def _read(self, run: Any, filmed: bool) -> list[int]:
        assert not filmed, "films take too long"
        if self.errors:
            raise self.errors.pop()
        return list(self.newest.values())

    def shown(self) -> tuple[list[int], int]:
        """Look for new checkpoints. Return the content and its number."""
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
    for errors in (runs.unopened, runs.errors):
        errors.append(error)
        assert runs.shown() == ([0, 0], 0)
    assert runs.shown() == ([1, 0], 1)


def test_the_state_says_whether_one_of_the_runs_is_being_written(
    runs: Runs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for path in runs.newest:
        path.mkdir()
    for written in ([], ["one"], ["other"], [], ["one", "other"]):
        with ExitStack() as locks:
            for name in written:
                locks.enter_context(directory.locked(Path(name)))
            runs.watched.look()
        assert json.loads(runs.watched.news(None, 0.0)) == {"count": 0, "going": bool(written)}


def test_an_unchanged_state_is_returned_after_the_given_time(runs: Runs) -> None:
    state, returned = runs.watched.news(None, 0.0), SimpleQueue[str]()
    threading.Thread(
        target=lambda: returned.put(runs.watched.news(state, 0.001)), daemon=True
    ).start()
    assert returned.get(timeout=20.0) == state


def test_the_run_is_no_longer_read_when_the_server_has_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ends, server, begun = SimpleQueue[bool](), MagicMock(), MagicMock()
    content = SimpleNamespace(follow=lambda ended: ends.put(ended.wait(20.0)))
    server.return_value.__enter__.return_value.serve_forever.side_effect = KeyboardInterrupt
    monkeypatch.setattr(watching, "Watched", lambda open_: content)
    monkeypatch.setattr(watching, "Server", server)
    with pytest.raises(KeyboardInterrupt):
        watching.watch(MagicMock(), 7, begun)
    server.assert_called_once_with(content, 7)
    begun.assert_called_once_with(server.return_value.__enter__.return_value.address)
    assert ends.get(timeout=20.0), "the reader of the run ends too"
