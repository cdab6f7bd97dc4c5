"""Simulators in this process, for one core or a single life."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import numpy as np

from primordia import own_code
from primordia.errors import Trouble
from primordia.pool.board import Field
from primordia.pool.contract import Pool, Simulator


class InProcess(Pool):
    """Simulators that are called directly."""

    def __init__(
        self, simulator: str, settings: dict[str, Any], fields: dict[str, Field], cells: int
    ) -> None:
        """Make the simulators; the arguments are those of `opening.open_pool`."""
        self._cells = range(cells)
        self.arrays = {
            name: np.zeros((cells, *shape), dtype) for name, (dtype, shape) in fields.items()
        }
        module, _, name = simulator.partition(":")
        with _trouble():
            kind = getattr(own_code.load(module), name)
            self._simulator: Simulator = kind(self.arrays, **settings)
            for cell in self._cells:
                self._simulator.make(cell)

    def begin(self, todo: np.ndarray) -> None:
        """Step the cells of `todo`, bool (N,), by one tick."""
        with _trouble():
            self._simulator.step(np.flatnonzero(todo).tolist())

    def finish(self) -> None:
        """Do nothing: `begin` has done the step."""

    def reset(self, todo: np.ndarray) -> None:
        """Begin new lives in the cells of `todo`, bool (N,)."""
        with _trouble():
            for cell in np.flatnonzero(todo).tolist():
                self._simulator.reset(cell)

    def save(self) -> list[bytes]:
        """Return the state of each cell's simulator."""
        with _trouble():
            return [self._simulator.save(cell) for cell in self._cells]

    def load(self, states: list[bytes]) -> None:
        """Restore the states that `save` returned."""
        with _trouble():
            for cell in self._cells:
                self._simulator.load(cell, states[cell])

    def close(self) -> None:
        """Release the simulators; a pool may be closed twice."""
        with suppress(AttributeError):
            del self._simulator


@contextmanager
def _trouble() -> Iterator[None]:
    """Turn any failure of a simulator into one line that says where it failed."""
    try:
        yield
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        what = " ".join(f"{type(error).__name__}: {error}".split()).removesuffix(":")
        raise Trouble(
            f"a simulator failed ({what}; {place.filename}, line {place.lineno});"
            " resume the run from its last checkpoint"
        ) from error
