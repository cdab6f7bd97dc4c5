"""Beginnings: worlds before anything has lived, and the random words newborn bodies are made of."""

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.law.law import Law
from primordia.law.seasons import ratchets
from primordia.law.world import Cause, Climate, Looks, Organisms, World, Worlds
from primordia.random.keys import Purpose, bits, stream
from primordia.random.wide import Wide, never, wide, zero


def begin(law: Law, seeds: list[int], tick: int = 0, births: int = 0) -> World:
    """Worlds in which nothing has ever lived. `settle` puts founders into them before the first tick.

    `tick` and `births` are what the counts start at.
    """
    return shared(_begin, law, tick, births)(wide(np.array(seeds, np.uint64)))


def _begin(law: Law, tick: int, births: int, seed: Wide) -> World:
    """As one compiled function: its operations compiled one by one take three times as long."""
    count, each = len(seed.lo), law.worlds * law.cells
    worlds = Worlds(
        seed=seed,
        tick=wide(np.full(count, tick, np.uint64)),
        births=wide(np.full(count, births, np.uint64)),
        deaths=zero((count, len(Cause))),
        extinctions=zero((count,)),
        organism_ticks=zero((count,)),
        food=zero((count,)),
        calm=jnp.zeros(count, jnp.int32),
        sample_wait=jnp.full(count, law.sample_every - tick % law.sample_every, jnp.int32),
        saturated=never((count,)),
        saturated_births=never((count,)),
        fixed=never((count,)),
        fixed_births=never((count,)),
        climate=climate(law, count),
        looks=looks(law, count, tick),
    )
    genome = {name: jnp.zeros((each, *shape), jnp.float32) for name, shape in law.layout.blocks}
    organisms = Organisms(
        alive=jnp.zeros(each, bool),
        genome=genome,
        notes=jnp.zeros((each, len(law.mutation.notes)), jnp.int32),
        memory=jnp.zeros((each, law.memory), jnp.float32),
        energy=jnp.zeros(each, jnp.int32),
        eaten=jnp.zeros(each, jnp.int32),
        born=zero((each,)),
        number=zero((each,)),
        branch=zero((each,)),
    )
    return World(organisms, worlds)


def birth_words(law: Law, worlds: Worlds, needed: Array, words: int) -> Array:
    """Random words for bodies born in this tick, uint32 (C, words); zeros unless needed, bool ()."""
    key = stream(worlds.seed, Purpose.BODY, worlds.tick).map(law.per_cell)
    return lax.cond(
        needed,
        lambda key: body_words(key, law.cell_numbers, words),
        lambda _: jnp.zeros((law.worlds * law.cells, words), jnp.uint32),
        key,
    )


def body_words(key: Wide, cells: Array, words: int) -> Array:
    """Random words for bodies born in these cells (N,) of their worlds, with keys (N,): (N, words)."""
    draws = jnp.arange(-(-words // 2), dtype=jnp.uint32)[:, None]
    # Cells on the last axis, which compilers turn into vector instructions.
    pairs = bits(key, cells, draws)
    return jnp.concatenate(pairs, axis=0)[:words].T


def climate(law: Law, count: int) -> Climate:
    """Return the settings that seasons may change, as a run begins with them, in `count` worlds."""
    return {name: jnp.full(count, value, jnp.float32) for name, value in law.beginning}


def looks(law: Law, count: int, tick: int) -> Looks:
    """What ratchets remember that have not looked yet, in worlds that stand at a tick."""
    every = [ratchet.every for ratchet in ratchets(law.seasons)]
    wait = np.array([e - tick % e for e in every], np.int32)
    nothing = (zero((count, len(every))) for _ in range(2))
    return Looks(jnp.asarray(np.tile(wait, (count, 1))), *nothing)
