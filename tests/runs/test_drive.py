"""The loop of a run with an invented engine: the order of its steps, its checkpoints, and its end."""

import signal
import time
from pathlib import Path
from typing import Any

import pytest

from primordia.runs import checkpoint, directory, loop
from primordia.runs.manifest import Progress
from primordia.settings.limits import Stop

CHUNK_S, EARLIER_S = 0.5, 20.0
"""Seconds that a chunk takes, and seconds that the run took before it was resumed."""
Step = tuple[Any, ...]


class Invented:
    """An engine and a recorder that log their calls; chunks are numbered from 1."""

    def __init__(self, chunks: int, press: int | None = None) -> None:
        """Run for some chunks, or press Ctrl-C in chunk `press`; 0 is before the first chunk."""
        self.log, self.done, self.chunks, self.press = list[Step](), 0, chunks, press

    def limits(self, stop: dict[str, Any]) -> dict[str, Any]:
        return stop

    def any_running(self, limits: dict[str, Any]) -> bool:
        assert limits == {"ticks": 9, "births": None, "until": None}
        if self.press == self.done == 0:
            signal.raise_signal(signal.SIGINT)
        return self.done < self.chunks

    def advance(self, limits: dict[str, Any]) -> str:
        self.done += 1
        if self.press == self.done:
            signal.raise_signal(signal.SIGINT)
        return f"events {self.done}"

    @property
    def faults(self) -> str:
        return f"faults {self.done}"

    def arrays(self) -> str:
        return f"state {self.done}"

    def append(self, events: str) -> None:
        self.log.append((events,))

    def finish(self) -> None:
        self.log.append(("finish",))


@pytest.fixture
def patched(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """Return a function that drives an invented run and returns its log."""

    def driven(run: Invented, every: float, listen: loop.Listener | None) -> list[Step]:
        progress = Progress(limits=Stop(ticks=9), wall_s=EARLIER_S, exact=True)

        def save(folder: Path, state: str, recorder: Any, now: Progress) -> None:
            assert (folder, recorder, now) == (tmp_path, run, progress)
            run.log.append(("save", state, now.wall_s - EARLIER_S))

        monkeypatch.setattr(checkpoint, "save", save)
        monkeypatch.setattr(directory, "note_faults", lambda _, lines: run.log.append((lines,)))
        monkeypatch.setattr(time, "perf_counter", lambda: CHUNK_S * run.done)
        engine: Any = run
        loop.drive(engine, engine, tmp_path, progress, every, listen)
        return run.log

    return driven


def noting(run: Invented) -> loop.Listener:
    def listen(status: loop.Status) -> None:
        assert status.engine is run
        assert status.limits == {"ticks": 9, "births": None, "until": None}
        run.log.append(("listen", status.wall_s))

    return listen


def chunk(number: int) -> list[Step]:
    """Return the steps of a chunk with a listener."""
    return [(f"events {number}",), (f"faults {number}",), ("listen", CHUNK_S * number)]


@pytest.mark.parametrize(
    ("every", "saves"), [(60.0, [3, 11, 31, 151]), (7.0, [3, 11, 25, 39]), (0.5, [2, 3, 4, 5])]
)
def test_each_chunk_is_recorded_and_reported_before_it_is_saved(
    every: float, saves: list[int], patched: Any
) -> None:
    """Early checkpoints are due 1 s, 4 s and 10 s after the one before, so that a run can be read soon.

    Time begins after the first chunk.
    """
    last, expected = saves[-1], list[Step]()
    for number in range(1, last + 1):
        saved = [("save", f"state {number}", CHUNK_S * number)] if number in saves else []
        expected += [*chunk(number), *saved]
    expected += [("finish",), ("save", f"state {last}", CHUNK_S * last)]
    run = Invented(last)
    assert patched(run, every, noting(run)) == expected


@pytest.mark.parametrize("press", [0, 1, 2])
def test_ctrl_c_in_a_chunk_saves_that_chunk_and_ends_no_segment(press: int, patched: Any) -> None:
    """Before the first chunk, it saves nothing."""
    run = Invented(5, press)
    with pytest.raises(KeyboardInterrupt):
        patched(run, 60.0, noting(run))
    saved = [("save", f"state {press}", CHUNK_S * press)] if press else []
    assert run.log == [*(step for number in range(press) for step in chunk(number + 1)), *saved]


def test_a_run_that_is_done_is_saved_once_more(patched: Any) -> None:
    assert patched(Invented(0), 0.0, None) == [("finish",), ("save", "state 0", 0.0)]


@pytest.mark.parametrize("error", [RuntimeError("no"), KeyboardInterrupt()])
def test_a_chunk_is_saved_before_the_error_of_a_listener(
    error: BaseException, patched: Any
) -> None:
    run = Invented(5)

    def listen(status: loop.Status) -> None:
        if run.done == 2:
            raise error

    with pytest.raises(type(error)):
        patched(run, 60.0, listen)
    assert run.log == [*chunk(1)[:2], *chunk(2)[:2], ("save", "state 2", 1.0)]
