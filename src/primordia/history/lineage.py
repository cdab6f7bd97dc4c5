"""Lines of descent: any organism's genome rebuilt from birth records alone, to the last bit.

A genome is its founder's and the mutations along the line of descent, replayed in order by the rule that
made them (`law.heredity`). A mutation gives the same bits on every device and version.
"""

from collections.abc import Mapping, Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia import device
from primordia.compiled import shared
from primordia.history.climate import climate_at
from primordia.law.heredity import Birth, mutation_rates, rebuild_genomes
from primordia.law.law import Law
from primordia.law.world import BirthCause, Climate
from primordia.mutations.contract import PURPOSES, Draws
from primordia.random.keys import streams
from primordia.random.wide import wide
from primordia.runs.archive import Archive
from primordia.runs.checkpoint import read_count
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
        found.append(_replay(run, children, climates[world](children.born), genome))
    return np.stack(found)


def descent(everyone: Lives, organism: int, world: int) -> np.ndarray:
    """Rows of an organism's line of descent, oldest first, down to itself, int64 (D,).

    Raises:
        InputError: no such organism was born.
    """
    rows = [everyone.row(organism, world)]
    while everyone.birth_cause[rows[-1]] != BirthCause.FOUNDER:
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
    number = read_count(state, "world.organisms.number")
    here = np.arange(len(number)) // law.cells == world
    (cell,) = np.flatnonzero(here & state["world.organisms.alive"] & (number == organism))
    return int(cell)


def _begun(run: Archive, line: Lives, world: int) -> tuple[np.ndarray, Lives]:
    """Return the oldest genome (P,) known of a line, and the births by which it goes on from there.

    In a fork it is that of the youngest of the line when the fork began; else there is none yet.
    """
    fork = run.config.fork
    older = int((line.born <= fork.tick).sum()) if fork is not None else 0
    if older and run.origin is not None:
        genome = genome_in(run.origin, run.law, int(line.id[older - 1]), world)
        return genome, line.take(slice(older, None))
    return np.zeros(run.law.layout.length, np.float32), line


def _replay(
    run: Archive, line: Lives, climate: Mapping[str, np.ndarray], genome: np.ndarray
) -> np.ndarray:
    """Replay the births of one line (D,) in order, from a genome (P,) -> the last one's."""
    notes = run.notes_of(line)
    replayed = shared(_replayed, run.law)
    for first in range(0, len(line), STEPS_AT_A_TIME):
        rows = np.arange(first, first + STEPS_AT_A_TIME)
        births, meant = line.take(rows % len(line)), rows < len(line)
        values = {name: each[rows % len(line)] for name, each in climate.items()}
        seed = wide(np.uint64(run.config.seed) + births.world.astype(np.uint64))
        genome = np.asarray(
            replayed(
                genome,
                (seed, wide(births.id), wide(births.born)),
                (births.cell, births.birth_cause == BirthCause.FOUNDER, meant),
                values,
                notes[rows % len(line)],
            )
        )
    return genome


def _replayed(
    law: Law, genome: Array, counts: tuple, marks: tuple, climate: Climate, notes: Array
) -> Array:
    """Replay births (S,), those that are meant, one after another -> genome (P,).

    Args:
        law: the law.
        genome: of the parent of the first, (P,).
        counts: seed of the world, birth number and tick of each birth, Wide.
        marks: cell within the world, whether it is a founder, and whether it is meant at all.
        climate: as it was at each birth.
        notes: of each newborn, int32 (S, n).
    """

    def birth(genome: Array, given: tuple) -> tuple[Array, None]:
        (seed, number, tick), (cell, founder, meant), climate, notes = jax.tree.map(
            jnp.atleast_1d, given
        )
        draws = Draws(streams(seed, tick, *PURPOSES), cell)
        of = Birth(seed, number, draws, founder, mutation_rates(law, climate))
        child = rebuild_genomes(law, of, genome[None], notes.reshape(1, -1))[0]
        return jnp.where(meant, child, genome), None

    return lax.scan(birth, jnp.asarray(genome), (counts, marks, climate, notes))[0]
