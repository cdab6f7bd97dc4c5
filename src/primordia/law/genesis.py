"""Genesis: worlds before the first organism, and the random words of newborn bodies."""

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.brains.contract import Genome
from primordia.brains.layout import BODY
from primordia.compiled import shared
from primordia.law import moments
from primordia.law.act import Acts
from primordia.law.law import Law
from primordia.law.seasons import ratchets
from primordia.law.world import Cause, Climate, Looks, Organisms, World, Worlds
from primordia.random.keys import Purpose, bits, stream
from primordia.random.wide import Wide, never, wide, zero


def begin(law: Law, seeds: np.ndarray) -> World:
    """Return worlds of these seeds, uint64 (W,), without organisms. `settle` adds founders before
    the first tick."""
    return shared(empty_worlds, law.compiled)(wide(seeds), beginning(law))


def empty_worlds(law: Law, seed: Wide, rates: Array | np.ndarray) -> World:
    """Make the worlds for `begin`; `rates` is `beginning(law)`.

    Callers compile this function, which cuts its time to a third.
    """
    count, cells, mutation = len(seed.lo), law.worlds * law.cells, law.heredity.mutation
    worlds = Worlds(
        seed=seed,
        tick=zero((count,)),
        births=zero((count,)),
        deaths=zero((count, len(Cause))),
        extinctions=zero((count,)),
        organism_ticks=zero((count,)),
        food=zero((count,)),
        calm=jnp.zeros(count, jnp.int32),
        sample_wait=jnp.full(count, law.sample_every, jnp.int32),
        saturated=never((count,)),
        saturated_births=never((count,)),
        fixed=never((count,)),
        fixed_births=never((count,)),
        climate=_climate(law, count, rates),
        looks=initial_looks(law, count, 0),
        acts=None if law.act is None else Acts(*(zero((count,)) for _ in Acts._fields)),
    )
    genome = {
        name: jnp.zeros((cells, *shape), jnp.float32) for name, shape in law.heredity.layout.blocks
    }
    organisms = Organisms(
        alive=jnp.zeros(cells, bool),
        genome=genome,
        notes=jnp.broadcast_to(mutation.founders_notes(1), (cells, len(mutation.notes))),
        memory=jnp.zeros((cells, law.memory), jnp.float32),
        energy=jnp.zeros(cells, jnp.int32),
        eaten=jnp.zeros(cells, jnp.int32),
        born=zero((cells,)),
        number=zero((cells,)),
        branch=zero((cells,)),
        moments=moments.none(cells, mutation.moments, law.senses, law.memory),
    )
    return World(organisms, worlds)


def birth_words(law: Law, world: World, needed: Array, words: int) -> Array:
    """Return the words of bodies born in this tick, or zeros if not `needed`; uint32 (C, words)."""
    (organisms, worlds), cells = world, law.cell_numbers
    key = stream(worlds.seed, Purpose.BODY, worlds.tick).map(law.per_cell)
    return lax.cond(
        needed,
        lambda key: words_of(law, organisms.genome, key, cells, words),
        lambda _: jnp.zeros((law.worlds * law.cells, words), jnp.uint32),
        key,
    )


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
    draws = jnp.arange(-(-words // 2), dtype=jnp.uint32)[:, None]
    # Cells are the last axis, which compilers turn into vector instructions.
    pairs = bits(key, cells, draws)
    return jnp.concatenate(pairs, axis=0)[:words].T


def initial_climate(law: Law, count: int) -> Climate:
    """Return the first values of the settings that seasons may change, in `count` worlds."""
    return _climate(law, count, beginning(law))


def beginning(law: Law) -> np.ndarray:
    """Return the first values of `law.rates`, float32 (R,)."""
    return np.array([value for _, value in law.beginning], np.float32)


def _climate(law: Law, count: int, rates: Array | np.ndarray) -> Climate:
    return {name: jnp.full(count, value) for name, value in zip(law.rates, rates, strict=True)}


def initial_looks(law: Law, count: int, tick: int) -> Looks:
    """Return the state of ratchets before their first measurement, in `count` worlds at a tick."""
    periods = [ratchet.every for ratchet in ratchets(law.seasons)]
    wait = np.array([period - tick % period for period in periods], np.int32)
    shape = count, len(periods)
    return Looks(jnp.asarray(np.tile(wait, (count, 1))), zero(shape), zero(shape))
