"""The settings that seasons change, as they stood in a world at any tick of its past."""

from collections.abc import Callable

import numpy as np
import pyarrow.compute as pc

from primordia.runs.archive import Archive


def climate_at(run: Archive, world: int) -> Callable[[np.ndarray], dict[str, np.ndarray]]:
    """What was in force: a function of ticks (n,) -> dotted setting, as in the metrics -> float32 (n,).

    A season that acts at the end of tick t is first felt in tick t + 1,
    and its sample bears t.
    """
    start, metrics = _at_the_beginning(run, world), None
    if run.config.seasons:
        metrics = run.metrics.filter(pc.equal(run.metrics["world"], world))

    def at(ticks: np.ndarray) -> dict[str, np.ndarray]:
        found = {name: np.full(len(ticks), value, np.float32) for name, value in start.items()}
        if metrics is not None:
            row = np.searchsorted(metrics["tick"].to_numpy(), ticks, side="left") - 1
            for name, values in found.items():
                values[row >= 0] = metrics[name].to_numpy()[row[row >= 0]]
        return found

    return at


def _at_the_beginning(run: Archive, world: int) -> dict[str, np.float32]:
    """Return the climate that a world's records begin with."""
    if (stored := run.origin) is None:
        return {name: np.float32(value) for name, value in run.law.beginning}
    return {name: stored[f"world.worlds.climate.{name}"][world] for name in run.law.rates}
