"""The settings that seasons change, as they stood in a world at any tick of its past."""

from collections.abc import Callable

import jax
import numpy as np
import pyarrow.compute as pc

from primordia.engine.state import named_leaves
from primordia.law import genesis
from primordia.law.sample import climate_columns, climate_values
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
    climate = genesis.climate(run.law, run.law.worlds)
    if (stored := run.origin) is not None:
        leaves = [stored[f"world.worlds.climate.{name}"] for name, _ in named_leaves(climate)]
        climate = jax.tree.unflatten(jax.tree.structure(climate), leaves)
    pairs = zip(climate_columns(run.law.layout.names), climate_values(climate), strict=True)
    return {name: np.asarray(values)[world] for name, values in pairs}
