"""Genesis: worlds before the first organism, and the random words of newborn bodies."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.brains.layout import BODY
from primordia.law import moments
from primordia.law.act import Acts
from primordia.law.law import Law
from primordia.law.seasons import ratchets
from primordia.law.world import Cause, Looks, Organisms, World, Worlds
from primordia.random.keys import Purpose, bits, stream
from primordia.random.wide import Wide, never, wide, zero


def begin(law: Law, seeds: np.ndarray) -> World:
    """Return worlds of these seeds, uint64 (W,), without organisms. `settle` adds founders before
    the first tick."""
    return jax.device_put(empty_worlds(law, wide(seeds)))


def empty_worlds(law: Law, seed: Wide, library: Any = np) -> World:
    """Return the worlds of `begin` as arrays of a library.

    It is NumPy, since JAX would compile code for each shape, or JAX's NumPy where only shapes matter.
    """
    count, cells, mutation = len(seed.lo), law.worlds * law.cells, law.heredity.mutation
    worlds = Worlds(
        seed=seed,
        tick=zero((count,), library),
        births=zero((count,), library),
        deaths=zero((count, len(Cause)), library),
        extinctions=zero((count,), library),
        organism_ticks=zero((count,), library),
        food=zero((count,), library),
        calm=library.zeros(count, np.int32),
        sample_wait=library.full(count, law.sample_every, np.int32),
        saturated=never((count,), library),
        saturated_births=never((count,), library),
        fixed=never((count,), library),
        fixed_births=never((count,), library),
        climate=initial_climate(law, count, library),
        looks=initial_looks(law, count, 0, library),
        acts=None if law.act is None else Acts(*(zero((count,), library) for _ in Acts._fields)),
    )
    genome = {
        name: library.zeros((cells, *shape), np.float32)
        for name, shape in law.heredity.layout.blocks
    }
    notes = library.zeros((cells, 0), np.int32)
    if mutation.notes:
        notes = jnp.broadcast_to(mutation.founders_notes(1), (cells, len(mutation.notes)))
    organisms = Organisms(
        alive=library.zeros(cells, bool),
        genome=genome,
        notes=notes,
        memory=library.zeros((cells, law.memory), np.float32),
        energy=library.zeros(cells, np.int32),
        eaten=library.zeros(cells, np.int32),
        born=zero((cells,), library),
        number=zero((cells,), library),
        branch=zero((cells,), library),
        moments=moments.none(cells, mutation.moments, law.senses, law.memory, library),
    )
    return World(organisms, worlds)


def birth_words(law: Law, world: World, words: int) -> Array:
    """Return the words of each organism's body at its birth, uint32 (C, words); see `words_of`."""
    seed = world.worlds.seed.map(law.per_cell)
    key = stream(seed, Purpose.BODY, world.organisms.born)
    return words_of(law, world.organisms.genome, key, law.cell_numbers, words)


def words_of(law: Law, genome: Genome | None, key: Wide, cells: Array, words: int) -> Array:
    """Return the words of N bodies, uint32 (N, words): genes of the body, if any, then random words.

    Args:
        law: the law.
        genome: blocks of the genomes, (N, *shape) each; None: all genes of the body are 0.
        key: keys of the births, (N,).
        cells: cells within worlds, (N,).
        words: number of words.
    """
    genes = law.heredity.layout.genes
    drawn = body_words(key, cells, words - genes)
    if not genes:
        return drawn
    own = jnp.zeros((len(drawn), genes), jnp.float32) if genome is None else genome[BODY]
    return jnp.concatenate([own.view(jnp.uint32), drawn], axis=1)


def body_words(key: Wide, cells: Array, words: int) -> Array:
    """Return random words for bodies, from keys (N,) and cells within worlds (N,): uint32 (N, words)."""
    draws: Any = np.arange(-(-words // 2), dtype=np.uint32)[:, None]
    # Cells are the last axis, which compilers turn into vector instructions.
    pairs = bits(key, cells, draws)
    library: Any = np if isinstance(pairs.lo, np.ndarray) else jnp
    return library.concatenate(pairs, axis=0)[:words].T


def initial_climate(law: Law, count: int, library: Any = np) -> dict[str, Any]:
    """Return the first values of the settings that seasons may change, in `count` worlds."""
    return {name: library.full(count, value, np.float32) for name, value in law.beginning}


def initial_looks(law: Law, count: int, tick: int, library: Any = np) -> Looks:
    """Return the state of ratchets before their first measurement, in `count` worlds at a tick."""
    periods = [ratchet.every for ratchet in ratchets(law.seasons)]
    wait = np.array([period - tick % period for period in periods], np.int32)
    shape = count, len(periods)
    return Looks(library.tile(wait, (count, 1)), zero(shape, library), zero(shape, library))
