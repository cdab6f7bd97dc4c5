"""The contracts between a habitat and its pool of simulators, and between the pool and a simulator."""

from abc import ABC, abstractmethod
from typing import Any, Protocol

import numpy as np


class Pool(ABC):
    """One simulator for each cell, and the arrays with the cells' actions and observations.

    All kinds of pools have the same numbers in their arrays after the same calls.
    """

    arrays: dict[str, np.ndarray]
    """the fields by name, each (N, ...)"""

    def step(self, todo: np.ndarray) -> None:
        """Step the cells of `todo`, bool (N,), by one tick.

        Raises:
            Trouble: a simulator failed.
        """
        self.begin(todo)
        self.finish()

    @abstractmethod
    def begin(self, todo: np.ndarray) -> None:
        """Begin a step, which `finish` ends; until then the pool takes no other call.

        So the workers of several pools can step at the same time.
        """

    @abstractmethod
    def finish(self) -> None:
        """End the step that `begin` began."""

    @abstractmethod
    def reset(self, todo: np.ndarray) -> None:
        """Begin new lives in the cells of `todo`, bool (N,)."""

    @abstractmethod
    def save(self) -> list[bytes]:
        """Return the state of each cell's simulator."""

    @abstractmethod
    def load(self, states: list[bytes]) -> None:
        """Restore states that the `save` of this pool, or of another pool, returned."""

    @abstractmethod
    def close(self) -> None:
        """Release the simulators."""


class Simulator(Protocol):
    """The simulators of some cells. They read and fill the cells' rows of `arrays`."""

    def __init__(self, arrays: dict[str, np.ndarray], **settings: Any) -> None: ...

    def make(self, cell: int) -> None:
        """Make a simulator for another cell."""

    def step(self, cells: list[int]) -> None:
        """Step each of these cells by one tick, with the actions in their rows."""

    def reset(self, cell: int) -> None:
        """Begin a new life, from the random words in the cell's row."""

    def save(self, cell: int) -> bytes:
        """Return the whole state, from which the simulator goes on exactly."""

    def load(self, cell: int, state: bytes) -> None:
        """Restore a state that `save` returned."""
