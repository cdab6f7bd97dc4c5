"""Simulators in worker processes: what happens when they fail."""

import errno
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from primordia import interrupts
from primordia.errors import Trouble
from primordia.pool import board
from primordia.pool import workers as pools
from primordia.pool.board import STEP
from primordia.pool.workers import Workers
from tests.commands import environment
from tests.counters import FIELDS

ALL = np.ones(7, bool)


@contextmanager
def counters(cells: int = 7, workers: int = 1) -> Iterator[Workers]:
    pool = Workers("tests.counters:Counters", {"start": 100}, FIELDS, cells, workers)
    try:
        yield pool
    finally:
        pool.close()


def gone(process: int) -> bool:
    """Return whether a process has ended, or is a zombie without a parent that waits."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return True
    return state == "Z"


def wait_until_gone(process: int) -> None:
    deadline = time.monotonic() + 30
    while not gone(process):
        assert time.monotonic() < deadline, "the process is still alive"
        time.sleep(0.01)


def test_a_worker_that_fails_is_noticed_at_once(capfd: pytest.CaptureFixture[str]) -> None:
    with counters() as pool:
        pool.reset(ALL)
        pool.arrays["add"][4] = -1
        with pytest.raises(Trouble, match=r"ended with status 1.*resume the run"):
            pool.step(ALL)
    assert "failed on request" in capfd.readouterr().err


def test_states_are_restored_without_a_time_limit_and_a_killed_worker_is_noticed() -> None:
    """A simulator without a state of its own lives a whole life again."""
    with counters() as pool:
        pool.reset(ALL)
        states = pool.save()
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(pools, "PATIENCE", 0)
            pool.load(states)
        assert pool.arrays["total"].tolist() == [100] * 7
        os.kill(int(pool.arrays["who"][2]), signal.SIGKILL)
        with pytest.raises(Trouble, match="ended with status -9"):
            pool.step(ALL)


def test_each_slow_reset_is_an_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only some cells begin new lives. No single reset takes longer than the run waits."""
    todo = np.array([True, False, True, True, False, True, False])
    with counters(workers=2) as pool:
        answers: list[int] = []
        monkeypatch.setattr(pools, "_receive", lambda worker, count: answers.append(count))
        pool.reset(todo)
        monkeypatch.undo()
        for worker, count in zip(pool._workers, answers, strict=True):
            pools._receive(worker, count)
        pool.step(ALL)
    assert answers == [2 + 1, 2 + 1]


def test_memory_that_is_shared_has_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """If there is none in memory, the file is where other temporary files are."""
    reserve, folders = board._reserve, []

    def full(file: int, begin: int, size: int) -> None:
        folders.append(os.readlink(f"/proc/self/fd/{file}"))
        if len(folders) < fits:
            raise OSError(errno.ENOSPC, "no space")
        reserve(file, begin, size)

    monkeypatch.setattr(board, "_reserve", full)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    fits = 2
    file, memory = board.shared_memory(4096)
    assert (len(memory), folders[-1].startswith(str(tmp_path))) == (4096, True)
    file.close()
    fits = 9
    with pytest.raises(Trouble, match="no room for the 4,096 bytes that simulators share"):
        board.shared_memory(4096)


def test_a_worker_that_hangs_is_noticed_after_a_time_limit_and_killed_at_the_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with counters(cells=2, workers=2) as pool:
        hanging, other = pool._workers
        pool.reset(np.ones(2, bool))
        monkeypatch.setattr(pools, "PATIENCE", 0.6)
        pool.arrays["add"][:] = [-3, 1]
        says = rf"worker process {hanging.pid} has not answered for 1 s; resume the run"
        with pytest.raises(Trouble, match=says):
            pool.step(np.ones(2, bool))
    assert [hanging.returncode, other.returncode] == [-signal.SIGKILL, 0]


def test_a_worker_that_cannot_start_is_an_error_that_says_why(
    capfd: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(Trouble, match="ended with status 1"):
        Workers("tests.counters:Missing", {"start": 0}, FIELDS, 2, 1)
    assert "Missing" in capfd.readouterr().err


def test_a_worker_whose_run_was_killed_prints_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    """A user who kills a run in the middle of a tick sees no tracebacks of workers."""
    with counters(cells=1, workers=1) as pool:
        worker = pool._workers[0]
        assert worker.stdin is not None
        assert worker.stdout is not None
        worker.stdout.close()
        worker.stdin.write(STEP)
        assert worker.wait(timeout=30) == 0
    assert capfd.readouterr().err == ""


def test_a_pool_without_references_is_closed() -> None:
    pool = Workers("tests.counters:Counters", {"start": 0}, FIELDS, 2, 1)
    pool.reset(np.ones(2, bool))
    workers = pool.arrays["who"].tolist()
    del pool
    for worker in workers:
        wait_until_gone(worker)


def test_workers_end_with_their_run_however_it_ends() -> None:
    """Shared memory ends with them: its file never had a name."""
    script = textwrap.dedent(
        """
        import sys, time
        import numpy as np
        from primordia.pool.workers import Workers
        from tests.counters import FIELDS
        pool = Workers("tests.counters:Counters", {"start": 0}, FIELDS, 2, 2)
        pool.reset(np.ones(2, bool))
        print(*pool.arrays["who"].tolist(), flush=True)
        time.sleep(100)
        """
    )
    before = set(Path("/dev/shm").iterdir())
    command = [sys.executable, "-c", script]
    run = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment())
    assert run.stdout is not None
    workers = [int(word) for word in run.stdout.readline().split()]
    assert len(workers) == 2
    assert set(Path("/dev/shm").iterdir()) == before
    run.kill()
    assert run.wait() == -signal.SIGKILL
    run.stdout.close()
    for worker in workers:
        wait_until_gone(worker)


def test_ctrl_c_ends_no_worker_and_a_signal_that_ends_the_run_kills_its_workers() -> None:
    """A terminal sends the signal to the run's process group only. A simulator may hang, so that its
    worker reads no command."""
    before = list(interrupts._undo)
    with counters(workers=2) as pool:
        groups = {os.getpgid(worker.pid) for worker in pool._workers}
        assert groups == {worker.pid for worker in pool._workers}
        for worker in pool._workers:
            worker.send_signal(signal.SIGINT)
        pool.reset(ALL)
        assert pool.arrays["total"].tolist() == [100] * 7
        (kill,) = [each for each in interrupts._undo if each not in before]
        kill()
        assert [worker.wait(30) for worker in pool._workers] == [-signal.SIGKILL] * 2
    assert interrupts._undo == before


PRINTING = """
class Own:
    def __init__(self, arrays, mark):
        arrays["mark"][:] = mark

    def make(self, cell):
        pass

    def step(self, cells):
        print("..")
"""


def test_a_simulator_on_the_path_gets_its_settings_and_may_print(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "printing_simulator.py").write_text(PRINTING)
    monkeypatch.syspath_prepend(tmp_path)
    fields = {"mark": ("int64", ())}
    pool = Workers("printing_simulator:Own", {"mark": 6}, fields, 3, 1)
    for _ in range(3):
        pool.step(np.ones(3, bool))
    assert pool.arrays["mark"].tolist() == [6] * 3
    pool.close()
    out, err = capfd.readouterr()
    assert (out, err) == ("", "..\n" * 3)
