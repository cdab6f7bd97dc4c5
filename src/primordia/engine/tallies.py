"""Tallies: what organisms have made of their lives (a score, kills), for people; the law never sees them.

A habitat on the host may keep them: `tallies`, their names, and `tally()`, int32 (C, K), of the lives
under way. They are noted beside the law's own lists, at each death and at each sample.
"""

from typing import Any

import numpy as np
from jax import Array

from primordia.habitats.contract import HostHabitat
from primordia.law.events import Events, Rows


def tally_columns(names: tuple[str, ...]) -> list[str]:
    """What a sample says of each of a habitat's tallies, over the living."""
    return [f"{name}_{what}" for name in names for what in ("mean", "best")]


class Tallies:
    """Rows of tallies that belong to the rows of a chunk's lists."""

    def __init__(self, habitat: HostHabitat, worlds: int) -> None:
        self.names = habitat.tallies
        self._habitat, self._worlds = habitat, worlds
        self.begin()

    def begin(self) -> None:
        """A chunk begins."""
        self._deaths = [np.zeros((0, len(self.names)), np.uint32)]
        self._samples = [np.zeros((0, len(tally_columns(self.names))), np.uint32)]
        self._sampled = 0

    def note_deaths(self, died: np.ndarray) -> None:
        """Of the cells of the dead, bool (C,), before others are born there."""
        if self.names and died.any():
            self._deaths.append(self._habitat.tally()[died].astype(np.uint32))

    def note_samples(self, alive: Array, samples: Rows) -> None:
        """If a sample was taken: of the living, bool (C,), the newborn among them."""
        if self.names and (filled := int(samples.filled)) > self._sampled:
            worlds = np.asarray(samples.rows)[self._sampled : filled, 0]
            self._samples.append(self._of_worlds(worlds, np.asarray(alive)))
            self._sampled = filled

    def beside(self, events: Events) -> Events:
        """The chunk's lists with what was noted in further columns."""
        if not self.names:
            return events
        deaths = _widened(events.deaths, np.concatenate(self._deaths))
        samples = _widened(events.samples, np.concatenate(self._samples))
        return events._replace(deaths=deaths, samples=samples)

    def _of_worlds(self, which: np.ndarray, alive: np.ndarray) -> np.ndarray:
        """Mean (the bits of a float32) and best of each tally in some worlds, uint32 (n, 2 K)."""
        tally = self._habitat.tally().reshape(self._worlds, -1, len(self.names))
        lives, rows = alive.reshape(self._worlds, -1), []
        for world in which:
            living = tally[world][lives[world]] if lives[world].any() else tally[world][:1] * 0
            mean = living.mean(axis=0).astype(np.float32).view(np.uint32)
            rows.append(np.stack([mean, living.max(axis=0).astype(np.uint32)], axis=1).ravel())
        return np.stack(rows)


def _widened(list_: Rows, columns: np.ndarray) -> Rows:
    rows = np.asarray(list_.rows)[: int(list_.filled)]
    assert len(rows) == len(columns), "tallies do not fit the events they belong to"
    wide: Any = np.concatenate([rows, columns], axis=1)
    return Rows(wide, list_.filled)
