"""Lines of descent: any organism's genome rebuilt from birth records alone, to the last bit.

A genome is its founder's plus the mutations along the line of descent, replayed in order. Only
integer draws, a table look-up, one product and one sum a weight are needed, so the device and the
version that lived it do not matter.
"""

from collections.abc import Sequence
from pathlib import Path

import jax.numpy as jnp
import numpy as np

from primordia import device
from primordia.brains.contract import join
from primordia.config import Config
from primordia.history.climate import climate_at
from primordia.law.law import Law
from primordia.law.mutation import ancestor_of, mutates, noise_index
from primordia.law.world import Origin
from primordia.random.gaussian import quantiles
from primordia.random.keys import Purpose, stream, streams
from primordia.random.wide import wide
from primordia.runs import checkpoint
from primordia.runs.checkpoint import Checkpoint
from primordia.runs.lives import Lives, lives
from primordia.runs.report import opened

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
    return rebuild_all(run, [(organism, world)])[0]


def rebuild_all(run: Path, organisms: Sequence[tuple[int, int]]) -> np.ndarray:
    """The genomes of some, by birth number and world, float32 (K, P); see `rebuild`."""
    device.prepare()
    config, _ = opened(run)
    everyone, origin = lives(run), checkpoint.origin(run)
    law = config.build_law(config.build_habitat())
    lines = [everyone.take(descent(everyone, *each)) for each in organisms]
    worlds = {world for _, world in organisms}
    climates = {world: climate_at(run, config, law, world) for world in worlds}
    found = []
    for (_, world), line in zip(organisms, lines, strict=True):
        genome = np.zeros(int(law.block_sizes.sum()), np.float32)
        if origin is not None and config.origin is not None:  # of a fork: genomes as it began
            older = line.born <= config.origin.tick
            if older.any():
                genome = genome_in(origin, law, line.take(older).id[-1], world)
            line = line.take(~older)
        with np.errstate(over="ignore", invalid="ignore"):  # a genome may have come to infinity
            found.append(_replay(law, config, line, climates[world](line.born), genome))
    return np.stack(found)


def descent(everyone: Lives, organism: int, world: int) -> np.ndarray:
    """Rows of an organism's line of descent, oldest first, down to itself, int64 (D,).

    Raises:
        InputError: no such organism was born.
    """
    rows = [everyone.row(organism, world)]
    while everyone.origin[rows[-1]] != Origin.FOUNDER:
        parent = int(everyone.parent_row[rows[-1]])
        if parent < 0:  # it died before a fork, whose records begin with those then alive
            break
        rows.append(parent)
    return np.array(rows[::-1])


def genome_in(stored: Checkpoint, law: Law, organism: int, world: int) -> np.ndarray:
    """The genome of somebody alive in a checkpoint, float32 (P,)."""
    arrays, cell = stored.arrays(), place_in(stored, law, organism, world)
    blocks = {name: arrays[f"world.organisms.genome.{name}"][[cell]] for name in law.blocks}
    return join(law.brain, blocks)[0]


def place_in(stored: Checkpoint, law: Law, organism: int, world: int) -> int:
    """The cell, on the axis of all worlds, of somebody alive in a checkpoint."""
    arrays = stored.arrays()
    hi, lo = (arrays[f"world.organisms.number.{half}"].astype(np.int64) for half in ("hi", "lo"))
    here = np.arange(len(hi)) // law.cells == world
    (cell,) = np.flatnonzero(here & arrays["world.organisms.alive"] & (hi << 32 | lo == organism))
    return int(cell)


def _replay(
    law: Law, config: Config, line: Lives, climate: dict[str, np.ndarray], genome: np.ndarray
) -> np.ndarray:
    """Births of one line (D,) in order, from a genome (P,) -> the last one's."""
    columns = ("probability", "scale")
    probability, scale = (
        np.stack([climate[f"mutation.{block}.{each}"] for block in law.blocks], axis=1)
        for each in columns
    )
    for first in range(0, len(line), STEPS_AT_A_TIME):
        rows = np.arange(first, first + STEPS_AT_A_TIME) % len(line)  # past the end, some again
        births, length = line.take(rows), len(genome)
        seed = np.uint64(config.seed) + births.world.astype(np.uint64)
        cells = jnp.asarray(births.cell)
        drawn = streams(wide(seed), wide(births.born), Purpose.MUTATE, Purpose.NOISE)
        per_weight = (
            np.repeat(each[rows], law.block_sizes, axis=1) for each in (probability, scale)
        )
        chance, size = per_weight
        takes = np.asarray(mutates(drawn[Purpose.MUTATE], cells, jnp.asarray(chance)))
        noise = quantiles()[np.asarray(noise_index(drawn[Purpose.NOISE], cells, length))] * size
        founders = _founders(law, config, births)
        for step in range(min(STEPS_AT_A_TIME, len(line) - first)):
            if births.origin[step] == Origin.FOUNDER:
                genome = founders[step]
            else:
                genome = np.where(takes[step], genome + noise[step], genome)
    return genome


def _founders(law: Law, config: Config, births: Lives) -> np.ndarray:
    """The genomes these (D,) would have if they were founders, float32 (D, P)."""
    seeds = wide(np.uint64(config.seed) + births.world.astype(np.uint64))
    if law.ancestors is not None:
        return law.ancestors[np.asarray(ancestor_of(seeds, wide(births.id), len(law.ancestors)))]
    drawn, length = stream(seeds, Purpose.FOUNDER, wide(births.born)), int(law.block_sizes.sum())
    index = noise_index(drawn, jnp.asarray(births.cell), length)
    return quantiles()[np.asarray(index)] * law.founder_scale
