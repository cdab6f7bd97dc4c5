"""The values of the settings that seasons change, at any tick of a run's past."""

import numpy as np

from primordia.runs.lives import Lives
from primordia.runs.records import Records

Climates = dict[str, np.ndarray]
"""Dotted name of each setting -> its values, float32 (n,)."""


class PastClimate:
    """The climates of all worlds of a run, as its metrics record them."""

    def __init__(self, run: Records) -> None:
        self._beginning, self._islands = _beginning(run), run.config.islands
        self._metrics: dict[str, np.ndarray] | None = None
        if run.config.seasons:
            columns = ("world", "tick", *self._beginning)
            metrics = {name: run.metrics[name].to_numpy() for name in columns}
            order = np.lexsort((metrics["tick"], metrics["world"]))
            self._metrics = {name: column[order] for name, column in metrics.items()}

    def of_lives(self, lives: Lives, ticks: np.ndarray) -> Climates:
        """Return the settings in force for n organisms, each at its own tick (n,)."""
        return self.of_cells(lives.world, lives.cell, ticks)

    def of_cells(self, worlds: np.ndarray, cells: np.ndarray, ticks: np.ndarray) -> Climates:
        """Return the settings in force in n cells of worlds, each at its own tick (n,)."""
        climates = self.of_worlds(worlds, ticks)
        return self._islands.here(climates, self._islands.of_cells(cells), np.where)

    def of_worlds(self, worlds: np.ndarray, ticks: np.ndarray) -> Climates:
        """Return the settings in force in n worlds, each at its own tick (n,), those of islands apart.

        A season that acts at the end of tick t is in force from tick t + 1 on; its sample has tick t.
        """
        climates = {name: start[worlds] for name, start in self._beginning.items()}
        if self._metrics is not None:
            row = self._last_sample_before(worlds, ticks)
            for name, values in climates.items():
                values[row >= 0] = self._metrics[name][row[row >= 0]]
        return climates

    def _last_sample_before(self, worlds: np.ndarray, ticks: np.ndarray) -> np.ndarray:
        """Return the row of the world's last sample before each tick, int64 (n,); -1 if there is none."""
        assert self._metrics is not None
        row = np.full(len(ticks), -1)
        for world in np.unique(worlds):
            first, last = np.searchsorted(self._metrics["world"], [world, world + 1])
            here = worlds == world
            earlier = np.searchsorted(self._metrics["tick"][first:last], ticks[here], side="left")
            row[here] = np.where(earlier > 0, first + earlier - 1, -1)
        return row


def _beginning(run: Records) -> Climates:
    """Return the climate at the beginning of each world's records, each (W,)."""
    if (stored := run.origin) is None:
        worlds = run.config.seeds
        return {
            name: np.full(worlds, value, np.float32)
            for name, value in run.description.beginning.items()
        }
    return {name: stored[f"world.worlds.climate.{name}"] for name in run.description.beginning}
