"""A worker process: keeps the simulators of its cells, and does with them what the run asks for.

    python -m primordia.pool.worker

Asked by single bytes on standard input, answered by single bytes on standard output. When the run is
gone, whatever became of it, standard input ends, and so does the worker. JAX is not loaded here.
"""

import json
import mmap
import os
import select
import signal
import sys
import time
from contextlib import suppress
from importlib import import_module
from typing import Any, Protocol

import numpy as np

from primordia.pool import board
from primordia.pool.board import LOAD, READY, RESET, SAVE, STEP

AWAKE = 0.002
"""Seconds for which a worker that has nothing to do keeps its core."""


class Simulator(Protocol):
    """What a worker keeps: the simulators of some cells. Rows of `arrays` are theirs to fill."""

    def __init__(self, arrays: dict[str, np.ndarray], **settings: Any) -> None: ...

    def make(self, cell: int) -> None:
        """The simulator of one more cell."""

    def step(self, cells: list[int]) -> None:
        """One tick of each of these cells, with what their rows say."""

    def reset(self, cell: int) -> None:
        """A new life, from the cell's random words."""

    def save(self, cell: int) -> bytes:
        """All that is needed to go on exactly."""

    def load(self, cell: int, state: bytes) -> None:
        """Take back what `save` gave."""


def main() -> None:
    """Set up as the first line says, then do as asked until the run is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the run's to hear
    _let_others_go_on()
    asked, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what libraries print is not an answer
    setup = json.loads(asked.readline())
    cells = range(setup["first"], setup["cells"], setup["every"])
    memory = mmap.mmap(setup["memory"], setup["size"])
    arrays = board.arrays(memory, setup["fields"], setup["cells"])
    module, _, name = setup["simulator"].partition(":")
    simulator = getattr(import_module(module), name)(arrays, **setup["settings"])
    for cell in cells:
        simulator.make(cell)
        answers.write(READY)
    serve(simulator, arrays["todo"], cells, asked, answers)


def _let_others_go_on() -> None:
    """Not take the core from the run at once when woken: it has other workers to wake still.

    Measured for 128 games on two cores: the second worker began 0.4 ms after the first.
    """
    if hasattr(os, "SCHED_BATCH"):
        with suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))


def serve(simulator: Simulator, todo: np.ndarray, cells: range, asked: Any, answers: Any) -> None:
    """Answer until nothing more is asked."""
    unbuffered = asked.fileno()
    own = np.arange(cells.start, cells.stop, cells.step)
    ear = select.poll()
    ear.register(unbuffered, select.POLLIN)
    while command := _heard(ear, unbuffered):
        if command == STEP:
            simulator.step(own[todo[own]].tolist())
        elif command == RESET:
            for cell in own[todo[own]].tolist():
                simulator.reset(cell)
        elif command == SAVE:
            for cell in own.tolist():
                state = simulator.save(cell)
                _write(answers, len(state).to_bytes(4, "little") + state)
        elif command == LOAD:
            for cell in own.tolist():
                length = int.from_bytes(_read(unbuffered, 4), "little")
                simulator.load(cell, _read(unbuffered, length))
        answers.write(READY)


def _heard(ear: select.poll, asked: int) -> bytes:
    """The next command, b"" at the end; at first the worker listens without falling asleep.

    The run takes half a millisecond from one tick to the next. A core that is put to sleep and woken
    for that, above all a virtual one, costs more: 32 games went on at 0.56 of the bare emulators' speed,
    and at 0.68 like this. The run has the core whenever it wants it.
    """
    tired = time.perf_counter() + AWAKE
    while not ear.poll(0) and time.perf_counter() < tired:
        os.sched_yield()
    return os.read(asked, 1)


def _write(answers: Any, data: bytes) -> None:
    while data:
        data = data[answers.write(data) :]


def _read(descriptor: int, count: int) -> bytes:
    parts, left = [], count
    while left:
        part = os.read(descriptor, left)
        if not part:
            raise EOFError
        parts.append(part)
        left -= len(part)
    return b"".join(parts)


if __name__ == "__main__":
    with suppress(BrokenPipeError):  # the run is gone, and hears no answer
        main()
