"""The settings that seasons change, as they stood in a world at any tick of its past."""

from collections.abc import Callable
from pathlib import Path

import jax
import numpy as np
import pyarrow.compute as pc

from primordia.config import Config
from primordia.engine.state import named_leaves
from primordia.law import genesis
from primordia.law.law import Law
from primordia.law.sample import climate_columns, climate_values
from primordia.runs import checkpoint
from primordia.runs.report import table


def climate_at(
    run: Path, config: Config, law: Law, world: int
) -> Callable[[np.ndarray], dict[str, np.ndarray]]:
    """What was in force: a function of ticks (n,) -> dotted setting, as in the metrics -> float32 (n,).

    The records are read once. A season that acts at the end of tick t is first felt in tick t + 1,
    and its sample bears t.
    """
    start = _at_the_beginning(run, law, world)
    metrics = table(run, "metrics") if config.seasons else None
    if metrics is not None:
        metrics = metrics.filter(pc.equal(metrics["world"], world))

    def at(ticks: np.ndarray) -> dict[str, np.ndarray]:
        found = {name: np.full(len(ticks), value, np.float32) for name, value in start.items()}
        if metrics is not None:
            row = np.searchsorted(metrics["tick"].to_numpy(), ticks, side="left") - 1
            for name, values in found.items():
                values[row >= 0] = metrics[name].to_numpy()[row[row >= 0]]
        return found

    return at


def _at_the_beginning(run: Path, law: Law, world: int) -> dict[str, np.float32]:
    climate = genesis.climate(law, law.worlds)
    if (origin := checkpoint.origin(run)) is not None:
        stored = origin.arrays()
        leaves = [stored[f"world.worlds.climate.{name}"] for name, _ in named_leaves(climate)]
        climate = jax.tree.unflatten(jax.tree.structure(climate), leaves)
    pairs = zip(climate_columns(law.layout.names), climate_values(climate), strict=True)
    return {name: np.asarray(values)[world] for name, values in pairs}
