"""A worker process, which keeps the simulators of its cells and carries out the run's commands.

    python -m primordia.pool.worker

A command is one byte on standard input; the answer is one byte on standard output. When the run
ends in any way, standard input closes, and the worker ends. This file does not load JAX.
"""

import json
import mmap
import os
import select
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from primordia import own_code
from primordia.own_code import Source
from primordia.pool import board
from primordia.pool.board import LOAD, READY, RESET, SAVE, STEP
from primordia.pool.contract import Simulator

BUSY_WAIT = 0.002
"""Seconds for which an idle worker keeps its core."""


def main() -> None:
    """Make the simulators that the first line of input describes, then serve the run until it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the run handles Ctrl-C
    _yield_to_the_run()
    commands, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # keeps the output of libraries apart from the answers
    setup = json.loads(commands.readline())
    cells = range(setup["first"], setup["cells"], setup["every"])
    memory = mmap.mmap(setup["memory"], setup["size"])
    arrays = board.arrays(memory, setup["fields"], setup["cells"])
    own_code.admit(
        {name: Source(Path(file), text.encode("latin-1")) for name, file, text in setup["code"]}
    )
    module, _, name = setup["simulator"].partition(":")
    simulator = getattr(own_code.load(module), name)(arrays, **setup["settings"])
    for cell in cells:
        simulator.make(cell)
        answers.write(READY)
    serve(simulator, arrays["todo"], cells, commands, answers)


def _yield_to_the_run() -> None:
    """Let the run keep its core while it wakes workers, since the run must wake all of them.

    Without this, the second worker began 0.4 ms after the first (128 games on two cores).
    """
    if hasattr(os, "SCHED_BATCH"):
        with suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))


def serve(
    simulator: Simulator, todo: np.ndarray, cells: range, commands: Any, answers: Any
) -> None:
    """Carry out and answer commands until the run closes their pipe."""
    unbuffered = commands.fileno()
    own = np.arange(cells.start, cells.stop, cells.step)
    poller = select.poll()
    poller.register(unbuffered, select.POLLIN)
    while command := _next_command(poller, unbuffered):
        if command == STEP:
            simulator.step(own[todo[own]].tolist())
        elif command == RESET:
            for cell in own[todo[own]].tolist():
                simulator.reset(cell)
                # Many slow resets take longer than the run waits for an answer.
                answers.write(READY)
        elif command == SAVE:
            for cell in own.tolist():
                state = simulator.save(cell)
                _write(answers, len(state).to_bytes(4, "little") + state)
        elif command == LOAD:
            for cell in own.tolist():
                length = int.from_bytes(_read(unbuffered, 4), "little")
                simulator.load(cell, _read(unbuffered, length))
        answers.write(READY)


def _next_command(poller: select.poll, commands: int) -> bytes:
    """Return the next command, b"" at the end. Wait actively at first, then sleep.

    The run takes half a millisecond from one tick to the next. Putting a core to sleep and waking
    it takes longer, above all on virtual machines: 32 games ran at 0.56 of the bare emulators'
    speed, and at 0.68 with active waiting. The run gets the core whenever it needs it.
    """
    end = time.perf_counter() + BUSY_WAIT
    while not poller.poll(0) and time.perf_counter() < end:
        os.sched_yield()
    return os.read(commands, 1)


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
    with suppress(BrokenPipeError):  # the run has ended
        main()
