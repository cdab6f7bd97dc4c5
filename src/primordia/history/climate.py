"""The values of the settings that seasons change, at any tick of a world's past."""

from collections.abc import Callable

import numpy as np
import pyarrow.compute as pc

from primordia.runs.archive import Archive


def climate_at(run: Archive, world: int) -> Callable[[np.ndarray], dict[str, np.ndarray]]:
    """Return a function of ticks (n,) -> {dotted setting: its value in each tick, float32 (n,)}.

    A season that acts at the end of tick t is in force from tick t + 1 on; its sample has tick t.
    """
    start, metrics = _beginning(run, world), None
    if run.config.seasons:
        metrics = run.metrics.filter(pc.equal(run.metrics["world"], world))

    def at(ticks: np.ndarray) -> dict[str, np.ndarray]:
        climate = {name: np.full(len(ticks), value, np.float32) for name, value in start.items()}
        if metrics is not None:
            row = np.searchsorted(metrics["tick"].to_numpy(), ticks, side="left") - 1
            for name, values in climate.items():
                values[row >= 0] = metrics[name].to_numpy()[row[row >= 0]]
        return climate

    return at


def _beginning(run: Archive, world: int) -> dict[str, np.float32]:
    """Return the climate that a world's records begin with."""
    if (stored := run.origin) is None:
        return {name: np.float32(value) for name, value in run.law.beginning}
    return {name: stored[f"world.worlds.climate.{name}"][world] for name in run.law.rates}
