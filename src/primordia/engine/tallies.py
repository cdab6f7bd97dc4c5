"""Tallies: counts in an organism's life that only people read, such as a score; the law never sees them.

A habitat on the host may keep tallies. Its `tallies` are the names, and its `tally()` returns the
counts of the present lives, int32 (C, K). Tallies become columns of the lists of deaths and samples.
"""

from typing import Any

import numpy as np
from jax import Array

from primordia.habitats.contract import HostHabitat
from primordia.law.events import Events, Rows


def tally_columns(names: tuple[str, ...]) -> list[str]:
    """Return the columns that a sample has for a habitat's tallies: mean and best of the living."""
    return [f"{name}_{what}" for name in names for what in ("mean", "best")]


class Tallies:
    """The tallies that belong to the rows of a chunk's lists."""

    def __init__(self, habitat: HostHabitat, worlds: int) -> None:
        self.names = habitat.tallies
        self._habitat, self._worlds = habitat, worlds
        self.begin()

    def begin(self) -> None:
        """Begin a chunk, which has no tallies yet."""
        self._deaths = [np.zeros((0, len(self.names)), np.uint32)]
        self._samples = [np.zeros((0, len(tally_columns(self.names))), np.uint32)]
        self._sampled = 0

    def note_deaths(self, died: np.ndarray) -> None:
        """Before a reset of bodies, note the tallies of organisms that died; `died` is bool (C,)."""
        if self.names and died.any():
            self._deaths.append(self._habitat.tally()[died].astype(np.uint32))

    def note_samples(self, alive: Array, samples: Rows) -> None:
        """If a sample was taken, note tallies of the living, newborn included; `alive` is bool (C,)."""
        if self.names and (filled := int(samples.filled)) > self._sampled:
            worlds = np.asarray(samples.rows)[self._sampled : filled, 0]
            self._samples.append(self._of_worlds(worlds, np.asarray(alive)))
            self._sampled = filled

    def added_to(self, events: Events) -> Events:
        """Return the chunk's lists with the tallies as further columns."""
        if not self.names:
            return events
        deaths = _widened(events.deaths, np.concatenate(self._deaths))
        samples = _widened(events.samples, np.concatenate(self._samples))
        return events._replace(deaths=deaths, samples=samples)

    def _of_worlds(self, numbers: np.ndarray, alive: np.ndarray) -> np.ndarray:
        """Return mean (the bits of a float32) and best of each tally in some worlds, uint32 (n, 2 K).

        Mean and best are 0 in a world without organisms.
        """
        tally = self._habitat.tally().reshape(self._worlds, -1, len(self.names))
        lives, rows = alive.reshape(self._worlds, -1), []
        for world in numbers:
            living = tally[world][lives[world]]
            if not len(living):
                living = np.zeros_like(tally[world][:1])
            mean = living.mean(axis=0).astype(np.float32).view(np.uint32)
            rows.append(np.stack([mean, living.max(axis=0).astype(np.uint32)], axis=1).ravel())
        return np.stack(rows)


def _widened(list_: Rows, columns: np.ndarray) -> Rows:
    rows = np.asarray(list_.rows)[: int(list_.filled)]
    assert len(rows) == len(columns), "there must be a row of tallies for each row of the list"
    widened: Any = np.concatenate([rows, columns], axis=1)
    return Rows(widened, list_.filled)
