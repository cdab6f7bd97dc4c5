"""Whether good lines persist, in the latest births that a view has seen."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from primordia.history.threshold import Threshold, over_births
from primordia.law.columns import Columns
from primordia.law.events import BIRTHS, DEATHS, Events, Rows
from primordia.runs.lives import ALIVE, Lives

KEPT = 4096
"""Number of latest births that are kept, of all worlds together. Parents born earlier are unknown."""


class Ground:
    """The latest births of a run, and which of these organisms died."""

    def __init__(self, cells: int, worlds: int) -> None:
        """Take the number of cells of a world, and the number of worlds."""
        self._cells = cells
        self._births = _Latest(BIRTHS, KEPT)
        # Since the first kept birth, at most those born since and those alive then have died.
        self._deaths = _Latest(DEATHS, KEPT + cells * worlds)

    def follow(self, events: Events) -> None:
        """Take the births and deaths of a chunk."""
        self._births.add(events.births)
        self._deaths.add(events.deaths)

    def measured(self, ticks: np.ndarray) -> list[Threshold]:
        """Return the error threshold of each world, measured in the world's kept births.

        Args:
            ticks: the present tick of each world, int64 (W,).
        """
        lives = self._lives(ticks)
        worlds = lives.by_world()
        return [
            over_births(world, each, np.array([0, len(each)]))[0]
            for world, each in enumerate(worlds)
        ]

    def _lives(self, ticks: np.ndarray) -> Lives:
        born, dead = self._births.columns(), self._deaths.columns()
        world = (born["cell"] // self._cells).astype(np.int32)
        order = np.lexsort((born["id"], world))
        born, world = {name: each[order] for name, each in born.items()}, world[order]
        count = len(world)
        lives = Lives(
            world=world,
            id=born["id"],
            parent=born["parent"],
            cell=(born["cell"] % self._cells).astype(np.int32),
            birth_cause=born["cause"].astype(np.int8),
            born=born["tick"],
            seen=born["tick"],
            inherited=np.zeros(count, bool),
            ended=ticks[world],
            cause=np.full(count, ALIVE, np.int8),
        )
        rows = lives.rows_of((dead["cell"] // self._cells).astype(np.int32), dead["id"])
        known = rows >= 0
        lives.ended[rows[known]] = dead["tick"][known]
        lives.cause[rows[known]] = dead["cause"][known]
        return lives


class Medians(NamedTuple):
    """Medians over the worlds in which all three numbers are known."""

    mutated: float
    as_good: float
    held: float


def medians(found: Sequence[Threshold]) -> Medians | None:
    """Return the medians of p, v and s (1 - p (1 - v)); None if they are known in no world."""
    known: list[Any] = [
        (each.mutated, each.as_good, each.held) for each in found if each.held is not None
    ]
    return Medians(*np.median(known, axis=0).tolist()) if known else None


class _Latest:
    """The latest rows of a list of events, up to a given number."""

    def __init__(self, columns: Columns, kept: int) -> None:
        self._columns, self._kept, self._count = columns, kept, 0
        self._parts = [np.zeros((0, columns.width), np.uint32)]

    def add(self, events: Rows) -> None:
        filled = int(events.filled)
        if not filled:
            return
        first = max(filled - self._kept, 0)
        own = np.asarray(events.rows)[first:filled, : self._columns.width]
        self._parts.append(own.copy())
        self._count += len(own)
        while self._count - len(self._parts[0]) >= self._kept:
            self._count -= len(self._parts.pop(0))

    def columns(self) -> dict[str, np.ndarray]:
        self._parts = [np.concatenate(self._parts)[-self._kept :]]
        self._count = len(self._parts[0])
        return self._columns.unpacked(self._parts[0])
