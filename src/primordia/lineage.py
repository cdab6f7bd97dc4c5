"""Lines of descent: any organism's genome rebuilt from birth records alone, to the last bit.

A genome is its founder's plus the mutations along the line of descent, replayed in order. Only
integer draws, a table look-up, one product and one sum a weight are needed, so the device and the
version that lived it do not matter.
"""

from pathlib import Path

import jax.numpy as jnp
import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from primordia.config import Config
from primordia.errors import InputError
from primordia.law import Law
from primordia.mutation import mutates, noise_index, quantiles, streams
from primordia.report import opened, table
from primordia.wide import wide

STEPS_AT_A_TIME = 64
"""Births replayed together; always as many, since JAX compiles anew for every shape."""


def rebuild(run: Path, organism: int, world: int = 0) -> np.ndarray:
    """The genome of an organism, float32 (P,), blocks of weights in the brain's order.

    Args:
        run: the run's directory.
        organism: its birth number, `id` in the records.
        world: where it lived.

    Raises:
        InputError: no such organism was born.
    """
    config, _ = opened(run)
    births = table(run, "births")
    line = descent(births, organism, world, str(run))
    law = config.build_law(config.build_habitat())
    climate = _climate_at(run, config, law, world, line["tick"])
    with np.errstate(over="ignore", invalid="ignore"):  # a genome may have come to infinity
        return _replay(law, config, line, climate, world)


def descent(births: pa.Table, organism: int, world: int, run: str) -> dict[str, np.ndarray]:
    """The births from a genome made from nothing down to an organism: tick, cell, cause, each (D,).

    Raises:
        InputError: no such organism was born.
    """
    mine = births.filter(pc.equal(births["world"], world))
    ids = mine["id"].to_numpy()
    parents = mine["parent"].fill_null(-1).to_numpy()
    causes = mine["cause"].combine_chunks().dictionary_decode().to_numpy(zero_copy_only=False)
    line = []
    at = organism
    while True:
        row = np.searchsorted(ids, at)
        if row == len(ids) or ids[row] != at:
            raise InputError(f"{run}: no organism {organism} was born in world {world}")
        line.append(row)
        if causes[row] == "founder":
            break
        at = parents[row]
    rows = np.array(line[::-1])
    ticks, cells = mine["tick"].to_numpy()[rows], mine["cell"].to_numpy()[rows]
    return {"tick": ticks, "cell": cells, "cause": causes[rows]}


def _climate_at(
    run: Path, config: Config, law: Law, world: int, ticks: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Mutation probability and scale (D, B) in force when these births happened.

    A season that acts at the end of tick t is first felt in tick t + 1, and its sample bears t.
    """
    names = law.blocks
    start = {
        "probability": config.mutation.probabilities(names),
        "scale": config.mutation.scales(names),
    }
    found = {
        field: np.tile(np.array(values, np.float32), (len(ticks), 1))
        for field, values in start.items()
    }
    if config.seasons:
        metrics = table(run, "metrics")
        metrics = metrics.filter(pc.equal(metrics["world"], world))
        row = np.searchsorted(metrics["tick"].to_numpy(), ticks, side="left") - 1
        for field, values in found.items():
            for b, name in enumerate(names):
                recorded = metrics[f"mutation.{name}.{field}"].to_numpy()
                values[row >= 0, b] = recorded[row[row >= 0]]
    return found["probability"], found["scale"]


def _replay(
    law: Law,
    config: Config,
    line: dict[str, np.ndarray],
    climate: tuple[np.ndarray, np.ndarray],
    world: int,
) -> np.ndarray:
    seed = np.uint64(config.seed + int(world))
    length = int(law.block_sizes.sum())
    genome = np.zeros(length, np.float32)
    for first in range(0, len(line["tick"]), STEPS_AT_A_TIME):
        ticks, cells = _filled(line["tick"], first), jnp.asarray(_filled(line["cell"], first))
        probability, scale = (
            np.repeat(_filled(each, first), law.block_sizes, axis=1) for each in climate
        )
        drawn = streams(wide(np.full(len(ticks), seed)), wide(ticks))
        takes = np.asarray(mutates(drawn, cells, jnp.asarray(probability)))
        noise = quantiles()[np.asarray(noise_index(drawn.noise, cells, length))] * scale
        for step, cause in enumerate(line["cause"][first : first + STEPS_AT_A_TIME]):
            if cause == "founder":
                index = noise_index(drawn.founder, cells, length)[step]
                genome = quantiles()[np.asarray(index)] * np.float32(config.mutation.founder_scale)
            else:
                genome = np.where(takes[step], genome + noise[step], genome)
    return genome


def _filled(each: np.ndarray, first: int) -> np.ndarray:
    """STEPS_AT_A_TIME entries from `first` on; past the end, some again."""
    some = each[first : first + STEPS_AT_A_TIME]
    return np.resize(some, (STEPS_AT_A_TIME, *some.shape[1:]))
