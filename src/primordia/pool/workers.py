"""Simulators, one for each cell, in worker processes that step in parallel on all cores.

Workers are started by a command rather than by `multiprocessing`, so scripts need no guard and notebooks
work. Rows of arrays go through shared memory, commands of one byte through pipes. A pipe closes
when one of its two processes has ended. So a worker's death is noticed at once, and no worker
outlives its run.
"""

import json
import os
import select
import subprocess
import sys
import weakref
from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from typing import Any

import numpy as np

from primordia import interrupts, own_code
from primordia.errors import Trouble
from primordia.pool import board
from primordia.pool.board import LOAD, READY, RESET, SAVE, STEP
from primordia.pool.contract import Pool

PATIENCE = 20.0
"""Longest wait for an answer of a worker, in seconds. A worker answers after each tick, and after each
simulator that it makes or resets."""


class Workers(Pool):
    """Workers and the arrays shared with them."""

    def __init__(
        self,
        simulator: str,
        settings: dict[str, Any],
        fields: dict[str, board.Field],
        cells: int,
        workers: int,
        modules: Sequence[str] = (),
    ) -> None:
        """Start the workers, at most one for each cell; the arguments are those of `opening.open_pool`.

        Raises:
            Trouble: a worker does not start.
        """
        # Workers read from `todo` which cells the next command is for.
        fields = {"todo": ("bool", ()), **fields}
        size = board.size(fields, cells)
        self._cells, self._count = cells, workers
        file, memory = board.shared_memory(size)
        self.arrays = board.arrays(memory, fields, cells)
        setup = {
            "simulator": simulator,
            "settings": settings,
            "fields": fields,
            "cells": cells,
            "every": self._count,
            "memory": file.fileno(),
            "size": size,
            "code": [
                (name, str(source.file), source.text.decode("latin-1"))
                for name, source in own_code.admitted(modules).items()
            ],
        }
        self._workers = [_spawn(file.fileno()) for _ in range(self._count)]
        # A signal may end the run while a simulator hangs and reads no commands.
        ended = ExitStack()
        ended.enter_context(interrupts.before_end(partial(_kill, self._workers)))
        self._finalizer = weakref.finalize(self, _stop, self._workers, ended)
        file.close()
        for first, worker in enumerate(self._workers):
            _send(worker, json.dumps({**setup, "first": first}).encode() + b"\n")
        for first, worker in enumerate(self._workers):
            _receive(worker, len(range(first, cells, self._count)) * len(READY))

    def begin(self, todo: np.ndarray) -> None:
        """Let all workers step the cells of `todo`, bool (N,), by one tick."""
        self.arrays["todo"][:] = todo
        self._command(STEP)

    def finish(self) -> None:
        """Wait until every worker has stepped.

        Raises:
            Trouble: a worker died, or does not answer.
        """
        for worker in self._workers:
            _receive(worker, len(READY))

    def reset(self, todo: np.ndarray) -> None:
        """Begin new lives in the cells of `todo`, bool (N,)."""
        self.arrays["todo"][:] = todo
        self._command(RESET)
        for first, worker in enumerate(self._workers):
            lives = int(np.count_nonzero(todo[first :: self._count]))
            _receive(worker, (lives + 1) * len(READY))

    def save(self) -> list[bytes]:
        """Return the state of each cell's simulator."""
        self._command(SAVE)
        states = [b""] * self._cells
        for first, worker in enumerate(self._workers):
            for cell in range(first, self._cells, self._count):
                length = int.from_bytes(_receive(worker, 4), "little")
                states[cell] = _receive(worker, length)
        self.finish()
        return states

    def load(self, states: list[bytes]) -> None:
        """Restore the states that `save` returned."""
        for first, worker in enumerate(self._workers):
            _send(worker, LOAD)
            for cell in range(first, self._cells, self._count):
                _send(worker, len(states[cell]).to_bytes(4, "little") + states[cell])
        for worker in self._workers:
            # The workers may have to live whole lives again.
            _receive(worker, len(READY), at_leisure=True)

    def close(self) -> None:
        """Stop the workers."""
        self._finalizer()

    def _command(self, command: bytes) -> None:
        for worker in self._workers:
            _send(worker, command)


def _spawn(memory: int) -> subprocess.Popen:
    command = [sys.executable, "-P", "-m", "primordia.pool.worker"]
    return subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        bufsize=0,
        pass_fds=[memory],
        process_group=0,  # Ctrl-C in a terminal goes to the run, which ends its workers
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )


def _send(worker: subprocess.Popen, data: bytes) -> None:
    assert worker.stdin is not None
    try:
        while data:
            data = data[worker.stdin.write(data) :]
    except BrokenPipeError:
        raise _has_ended(worker) from None


def _receive(worker: subprocess.Popen, count: int, at_leisure: bool = False) -> bytes:
    """Return `count` bytes; wait PATIENCE seconds for each, or, `at_leisure`, until the worker ends."""
    assert worker.stdout is not None
    parts, left = [], count
    while left:
        ready, _, _ = select.select([worker.stdout], [], [], None if at_leisure else PATIENCE)
        if not ready:
            raise Trouble(
                f"worker process {worker.pid} has not answered for {PATIENCE:.0f} s; resume the run"
                " from its last checkpoint"
            )
        part = os.read(worker.stdout.fileno(), left)
        if not part:
            raise _has_ended(worker)
        parts.append(part)
        left -= len(part)
    return b"".join(parts)


def _has_ended(worker: subprocess.Popen) -> Trouble:
    return Trouble(
        f"worker process {worker.pid} ended with status {worker.wait()} (its messages are above);"
        " resume the run from its last checkpoint"
    )


def _kill(workers: list[subprocess.Popen]) -> None:
    for worker in workers:
        worker.kill()


def _stop(workers: list[subprocess.Popen], ended: ExitStack) -> None:
    """Close the workers' input, which ends them, and kill those that are alive a second later."""
    ended.close()
    for worker in workers:
        assert worker.stdin is not None
        assert worker.stdout is not None
        worker.stdin.close()
        worker.stdout.close()
    for worker in workers:
        try:
            worker.wait(timeout=1)
        except subprocess.TimeoutExpired:
            worker.kill()
            worker.wait()
