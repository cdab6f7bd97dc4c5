"""Simulators for tests of the pool: each cell counts, and fails on request, or tells its tree."""

import os
import time
from pathlib import Path

import numpy as np

from primordia.pool import board

MANY = 10_000
"""Length of a saved state, in copies of a number; the pipe to a worker holds 64 KiB."""
FIELDS = {"add": ("int64", ()), "total": ("int64", ()), "who": ("int64", ())}


class Counters:
    """Counters whose `total` grows by `add`. Adding -1 raises, -2 ends the process, -3 sleeps."""

    def __init__(self, arrays: dict[str, np.ndarray], start: int) -> None:
        self._arrays, self._start = arrays, start
        self._total: dict[int, int] = {}

    def make(self, cell: int) -> None:
        self._total[cell] = 0

    def step(self, cells: list[int]) -> None:
        for cell in cells:
            self._step(cell)

    def _step(self, cell: int) -> None:
        add = int(self._arrays["add"][cell])
        if add == -1:
            raise ValueError("failed on request")
        if add == -2:
            os._exit(7)
        if add == -3:
            time.sleep(100)
        self._total[cell] += add
        self._publish(cell)

    def _publish(self, cell: int) -> None:
        self._arrays["total"][cell] = self._total[cell]
        self._arrays["who"][cell] = os.getpid()

    def reset(self, cell: int) -> None:
        self._total[cell] = self._start
        self._publish(cell)

    def save(self, cell: int) -> bytes:
        return str(self._total[cell]).encode() * (MANY * (cell + 1))

    def load(self, cell: int, state: bytes) -> None:
        text = state.decode()
        self._total[cell] = int(text[: len(text) // (MANY * (cell + 1))])
        self._publish(cell)


class Place:
    """A simulator that reports whether its process imports the tree whose package is in a folder."""

    def __init__(self, arrays: dict[str, np.ndarray], source: str) -> None:
        self._arrays, self._source = arrays, Path(source)

    def make(self, cell: int) -> None:
        self._arrays["same"][cell] = False

    def reset(self, cell: int) -> None:
        self._arrays["same"][cell] = Path(board.__file__) == self._source / "pool" / "board.py"
