"""Lines of descent: any organism's genome rebuilt from birth records alone, to the last bit.

A genome is its founder's plus the mutations along the line of descent, replayed in order. Only
integer draws, a table look-up, one product and one sum a weight are needed, so the device and the
version that lived it do not matter.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jax import Array

from primordia import device
from primordia.compiled import shared
from primordia.config import Config
from primordia.history.climate import climate_at
from primordia.law.law import Law
from primordia.law.mutation import ancestor_of, mutates, noise_index
from primordia.law.world import Origin
from primordia.random.gaussian import quantiles
from primordia.random.keys import Purpose, stream, streams
from primordia.random.wide import Wide, wide
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import count
from primordia.runs.lives import Lives

STEPS_AT_A_TIME = 64
"""Births replayed together; always as many, since JAX compiles anew for every shape."""


def rebuild(run: Archive, organism: int, world: int = 0) -> np.ndarray:
    """The genome of an organism, float32 (P,), blocks of weights in the brain's order.

    Args:
        run: where it lived.
        organism: its birth number, `id` in the records.
        world: its world.

    Raises:
        InputError: no such organism was born.
    """
    return rebuild_all(run, [(organism, world)])[0]


def rebuild_all(run: Archive, organisms: Sequence[tuple[int, int]]) -> np.ndarray:
    """The genomes of some, by birth number and world, float32 (K, P); see `rebuild`."""
    device.prepare()
    lines = [run.lives.take(descent(run.lives, *each)) for each in organisms]
    climates = {world: climate_at(run, world) for world in {world for _, world in organisms}}
    found = []
    for (_, world), line in zip(organisms, lines, strict=True):
        genome, children = _begun(run, line, world)
        climate = climates[world](children.born)
        with np.errstate(over="ignore", invalid="ignore"):  # a genome may have come to infinity
            found.append(_replay(run.law, run.config, children, climate, genome))
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


def genome_in(state: Mapping[str, np.ndarray], law: Law, organism: int, world: int) -> np.ndarray:
    """The genome of an organism that is alive in a state, float32 (P,)."""
    cell = place_in(state, law, organism, world)
    blocks = {name: state[f"world.organisms.genome.{name}"][[cell]] for name in law.layout.names}
    return law.layout.join(blocks)[0]


def place_in(state: Mapping[str, np.ndarray], law: Law, organism: int, world: int) -> int:
    """The cell, on the axis of all worlds, of an organism that is alive in a state."""
    number = count(state, "world.organisms.number")
    here = np.arange(len(number)) // law.cells == world
    (cell,) = np.flatnonzero(here & state["world.organisms.alive"] & (number == organism))
    return int(cell)


def _begun(run: Archive, line: Lives, world: int) -> tuple[np.ndarray, Lives]:
    """Return the oldest genome (P,) known of a line, and the children that descend from it.

    It is that of the founder or, in a fork, that of the youngest of the line when the fork began.
    """
    fork = run.config.origin
    older = int((line.born <= fork.tick).sum()) if fork is not None else 0
    if older and run.origin is not None:
        genome = genome_in(run.origin, run.law, int(line.id[older - 1]), world)
        return genome, line.take(slice(older, None))
    return _founder(run.law, run.config, line.take(slice(1))), line.take(slice(1, None))


def _replay(
    law: Law, config: Config, line: Lives, climate: dict[str, np.ndarray], genome: np.ndarray
) -> np.ndarray:
    """Births of children of one line (D,) in order, from a genome (P,) -> the last one's."""
    columns = ("probability", "scale")
    probability, scale = (
        np.stack([climate[f"mutation.{block}.{each}"] for block in law.layout.names], axis=1)
        for each in columns
    )
    draw = shared(_drawn, len(genome))
    for first in range(0, len(line), STEPS_AT_A_TIME):
        rows = np.arange(first, first + STEPS_AT_A_TIME) % len(line)  # past the end, some again
        chance, size = (
            np.repeat(each[rows], law.layout.sizes, axis=1) for each in (probability, scale)
        )
        births = line.take(rows)
        takes, index = draw(_seeds(config, births), wide(births.born), births.cell, chance)
        noise = quantiles()[np.asarray(index)] * size
        mutated = np.asarray(takes)
        for step in range(min(STEPS_AT_A_TIME, len(line) - first)):
            genome = np.where(mutated[step], genome + noise[step], genome)
    return genome


def _drawn(
    length: int, seeds: Wide, born: Wide, cells: Array, chance: Array
) -> tuple[Array, Array]:
    """Return what K children draw: which of their weights take noise, (K, P), and which noise."""
    drawn = streams(seeds, born, Purpose.MUTATE, Purpose.NOISE)
    takes = mutates(drawn[Purpose.MUTATE], cells, chance)
    return takes, noise_index(drawn[Purpose.NOISE], cells, length)


def _founder(law: Law, config: Config, birth: Lives) -> np.ndarray:
    """The genome of a founder by its record (1,), float32 (P,)."""
    seeds = _seeds(config, birth)
    if law.ancestors is not None:
        return law.ancestors[np.asarray(ancestor_of(seeds, wide(birth.id), len(law.ancestors)))][0]
    draw = shared(_drawn_by_founder, law.layout.length)
    index = np.asarray(draw(seeds, wide(birth.born), birth.cell))
    return (quantiles()[index] * law.founder_scale)[0]


def _drawn_by_founder(length: int, seeds: Wide, born: Wide, cells: Array) -> Array:
    """Return which noise makes the weights of founders, (K, P)."""
    return noise_index(stream(seeds, Purpose.FOUNDER, born), cells, length)


def _seeds(config: Config, births: Lives) -> Wide:
    """Seeds of the worlds of births."""
    return wide(np.uint64(config.seed) + births.world.astype(np.uint64))
