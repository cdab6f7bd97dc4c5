"""Lineages: the genome of any organism rebuilt from birth records alone, to the last bit.

The founder's genome is made first. Then the mutations along the line of descent are replayed in order, by
the rule that made them (`law.heredity`). A mutation gives the same bits on every device and with
every version of the packages.
"""

from collections.abc import Iterator, Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia import device
from primordia.compiled import shared
from primordia.history import pedigree
from primordia.history.births import genome_in, recorded
from primordia.history.climate import PastClimate
from primordia.law.heredity import Heredity
from primordia.law.world import BirthCause, Climate
from primordia.progress import steps
from primordia.random.wide import wide
from primordia.runs.lives import Lives
from primordia.runs.records import Records

STEPS_AT_A_TIME = 64
"""Births replayed in one call; the number is fixed, since JAX compiles for every new shape."""


def rebuild(run: Records, organism: int, world: int = 0) -> np.ndarray:
    """Return the genome of an organism, float32 (P,), with blocks of weights in the brain's order.

    Args:
        run: the organism's run.
        organism: birth number, `id` in the records.
        world: the organism's world.

    Raises:
        InputError: no such organism was born.
    """
    return rebuild_all(run, [(organism, world)])[0]


def rebuild_all(run: Records, organisms: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return the genomes of K organisms, by birth number and world, float32 (K, P); see `rebuild`."""
    # With mates, a line of descent has two parents at each step. Without, a call replays some births of a
    # line, or a generation of a pedigree.
    worlds = len({world for _, world in organisms})
    if run.schema.mates or len(organisms) > STEPS_AT_A_TIME * worlds:
        return pedigree.genomes(run, np.array([run.lives.row(*each) for each in organisms]))
    device.prepare()
    lineages = [run.lives.take(descent(run.lives, *each)) for each in organisms]
    past, genomes = PastClimate(run), []
    for lineage in steps(lineages, "rebuilding genomes"):
        genome, births = _starting_point(run, lineage)
        for last, _ in _replayed(run, past, births, genome):
            genome = last
        genomes.append(genome)
    return np.stack(genomes)


def descent(lives: Lives, organism: int, world: int) -> np.ndarray:
    """Return the rows of an organism's ancestors, oldest first, then its own row, int64 (D,).

    Raises:
        InputError: no such organism was born.
    """
    rows = [lives.row(organism, world)]
    while lives.birth_cause[rows[-1]] != BirthCause.FOUNDER:
        parent = int(lives.parent_row[rows[-1]])
        if parent < 0:  # the parent died before the fork that this run began with
            break
        rows.append(parent)
    return np.array(rows[::-1])


def changes(run: Records, organism: int, world: int = 0) -> np.ndarray:
    """Return the distance from the parent's genome to each genome on a line of descent, float64 (D, B).

    The distance is the Euclidean (L2) norm of the change in each block of weights. If there are two
    parents, the first one is meant. The distance is NaN if the parent's genome is unknown, as for
    founders and for organisms alive at a fork.

    Raises:
        InputError: no such organism was born, or the mutation is code that the user has not trusted.
    """
    rows = descent(run.lives, organism, world)
    found = np.full((len(rows), len(run.layout.names)), np.nan)
    if run.schema.mates:
        made = run.layout.split(np.diff(pedigree.genomes(run, rows), axis=0))
        each = [np.linalg.norm(block.reshape(len(block), -1), axis=1) for block in made.values()]
        found[1:] = np.stack(each, axis=1)
        return found
    device.prepare()
    lineage = run.lives.take(rows)
    genome, births = _starting_point(run, lineage)
    parts = [part for _, part in _replayed(run, PastClimate(run), births, genome)]
    if parts:
        found[len(rows) - len(births) :] = np.concatenate(parts)[: len(births)]
    found[lineage.birth_cause == BirthCause.FOUNDER] = np.nan
    return found


def _starting_point(run: Records, lineage: Lives) -> tuple[np.ndarray, Lives]:
    """Return the genome from which a lineage starts, (P,), and the births to replay after it.

    In a fork the lineage starts from its youngest organism at the fork, if there is one.
    Otherwise the genome is all zeros, and the founder's birth is the first to be replayed.
    """
    fork = run.config.fork
    older = int((lineage.born <= fork.tick).sum()) if fork is not None else 0
    if older and run.origin is not None:
        youngest = int(lineage.id[older - 1]), int(lineage.world[0])
        genome = genome_in(run.origin, run.layout, *youngest)
        return genome, lineage.take(slice(older, None))
    return np.zeros(run.layout.length, np.float32), lineage


def _replayed(
    run: Records, past: PastClimate, lineage: Lives, genome: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Replay the births of a lineage (D,) in order, from a genome (P,), part by part.

    Yields the last genome of each part, and the change in each birth of the part; see `changes`.
    """
    replay = shared(_replay_births, run.heredity)
    notes, climate = run.notes_of(lineage), past.of_lives(lineage, lineage.born)
    for first in range(0, len(lineage), STEPS_AT_A_TIME):
        rows = np.arange(first, first + STEPS_AT_A_TIME)
        births, real = lineage.take(rows % len(lineage)), rows < len(lineage)
        values = {name: each[rows % len(lineage)] for name, each in climate.items()}
        seed = wide(run.world_seeds[births.world])
        last, norms = replay(
            genome,
            (seed, wide(births.id), wide(births.born)),
            (births.cell, births.birth_cause == BirthCause.FOUNDER, real),
            values,
            notes[rows % len(lineage)],
        )
        genome = np.asarray(last)
        yield genome, np.asarray(norms)


def _replay_births(
    heredity: Heredity,
    genome: Array,
    counts: tuple,
    marks: tuple,
    climate: Climate,
    notes: Array,
) -> tuple[Array, Array]:
    """Replay births (S,) one after another, except those that only pad the shape.

    Args:
        heredity: the heredity of the run.
        genome: genome of the first parent, (P,).
        counts: seed of the world, birth number and tick of each birth, Wide.
        marks: cell within the world; whether the newborn is a founder; whether the birth is real.
        climate: values of the settings at each birth.
        notes: the mutation's notes at each birth, int32 (S, n).

    Returns:
        The last genome, float32 (P,), and the norm of each birth's change in each block, float32 (S, B).
    """

    def step(genome: Array, given: tuple) -> tuple[Array, Array]:
        (seed, number, tick), (cell, founder, real), climate, notes = jax.tree.map(
            jnp.atleast_1d, given
        )
        birth = recorded(heredity, (seed, number, tick), (cell, founder), climate)
        child = heredity.rebuild_genomes(birth, genome[None], notes.reshape(1, -1))[0]
        change = heredity.layout.split(child - genome).values()
        norms = jnp.stack([jnp.linalg.norm(block.ravel()) for block in change])
        return jnp.where(real, child, genome), norms

    return lax.scan(step, jnp.asarray(genome), (counts, marks, climate, notes))
