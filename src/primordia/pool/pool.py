"""Simulators in worker processes: one a cell, stepped side by side on all cores.

Workers are started from the command line rather than by `multiprocessing`, so scripts need no guard and
notebooks work. Rows of arrays go through shared memory, single bytes through pipes: they end when
either side does, so a worker that dies is noticed at once, and none outlives its run.
"""

import json
import os
import select
import subprocess
import sys
import weakref
from typing import Any

import numpy as np

from primordia.errors import Trouble
from primordia.pool import board
from primordia.pool.board import LOAD, READY, RESET, SAVE, STEP

PATIENCE = 20.0
"""Seconds without a sign of life after which a worker is given up; each simulator made is one."""


class Pool:
    """Workers and the arrays shared with them."""

    def __init__(
        self,
        simulator: str,
        settings: dict[str, Any],
        fields: dict[str, board.Field],
        cells: int,
        workers: int | None = None,
    ) -> None:
        """Start workers, as many as cores or cells unless said.

        Args:
            simulator: `module:Class` that keeps the contract of `worker.Simulator`.
            settings: its own, as JSON can hold them.
            fields: what the arrays are; `todo` (bool) is added: cells the next command is for.
            cells: how many simulators.
            workers: how many processes.

        Raises:
            Trouble: a worker does not come up.
        """
        fields = {"todo": ("bool", ()), **fields}
        size = board.size(fields, cells)
        self._cells = cells
        self._count = min(workers or len(os.sched_getaffinity(0)), cells)
        file, memory = board.shared(size)
        self.arrays = board.arrays(memory, fields, cells)
        setup = {
            "simulator": simulator,
            "settings": settings,
            "fields": fields,
            "cells": cells,
            "every": self._count,
            "memory": file.fileno(),
            "size": size,
        }
        self._workers = [_spawn(file.fileno()) for _ in range(self._count)]
        self._finalizer = weakref.finalize(self, _stop, self._workers)
        file.close()
        for first, worker in enumerate(self._workers):
            _put(worker, json.dumps({**setup, "first": first}).encode() + b"\n")
        for first, worker in enumerate(self._workers):
            _ready(worker, len(range(first, cells, self._count)))

    def step(self, todo: np.ndarray) -> None:
        """One tick of the cells todo, bool (N,).

        Raises:
            Trouble: a worker died, or does not answer.
        """
        self.arrays["todo"][:] = todo
        self._ask(STEP)
        self._gather()

    def reset(self, todo: np.ndarray) -> None:
        """New lives in the cells todo, bool (N,)."""
        self.arrays["todo"][:] = todo
        self._ask(RESET)
        self._gather()

    def save(self) -> list[bytes]:
        """The state of each cell's simulator."""
        self._ask(SAVE)
        states = [b""] * self._cells
        for first, worker in enumerate(self._workers):
            for cell in range(first, self._cells, self._count):
                length = int.from_bytes(_get(worker, 4), "little")
                states[cell] = _get(worker, length)
        self._gather()
        return states

    def load(self, states: list[bytes]) -> None:
        """Take back what `save` gave."""
        for first, worker in enumerate(self._workers):
            _put(worker, LOAD)
            for cell in range(first, self._cells, self._count):
                _put(worker, len(states[cell]).to_bytes(4, "little") + states[cell])
        self._gather()

    def close(self) -> None:
        """Stop the workers."""
        self._finalizer()

    def _ask(self, command: bytes) -> None:
        for worker in self._workers:
            _put(worker, command)

    def _gather(self) -> None:
        """Hear from every worker that it is done."""
        for worker in self._workers:
            _ready(worker)


def _spawn(memory: int) -> subprocess.Popen:
    command = [sys.executable, "-m", "primordia.pool.worker"]
    return subprocess.Popen(
        command,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        bufsize=0,
        pass_fds=[memory],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )


def _put(worker: subprocess.Popen, data: bytes) -> None:
    assert worker.stdin is not None
    try:
        while data:
            data = data[worker.stdin.write(data) :]
    except BrokenPipeError:
        raise _lost(worker) from None


def _ready(worker: subprocess.Popen, times: int = 1) -> None:
    """Hear that it is done, with so many things."""
    if _get(worker, times * len(READY)) != times * READY:
        raise Trouble("a worker process gave an answer that makes no sense")


def _get(worker: subprocess.Popen, count: int) -> bytes:
    assert worker.stdout is not None
    parts, left = [], count
    while left:
        ready, _, _ = select.select([worker.stdout], [], [], PATIENCE)
        if not ready:
            raise Trouble(
                f"worker process {worker.pid} has not answered for {PATIENCE:.0f} s; resume the run"
                " from its last checkpoint"
            )
        part = os.read(worker.stdout.fileno(), left)
        if not part:
            raise _lost(worker)
        parts.append(part)
        left -= len(part)
    return b"".join(parts)


def _lost(worker: subprocess.Popen) -> Trouble:
    return Trouble(
        f"worker process {worker.pid} ended with status {worker.wait()} (what it said is above);"
        " resume the run from its last checkpoint"
    )


def _stop(workers: list[subprocess.Popen]) -> None:
    """End of input ends a worker; one that does not listen is killed."""
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
