"""Bodies in JAX: made from random words, put into cells, and found to be broken."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.habitats.contract import Bodies, JaxHabitat


def fresh(habitat: JaxHabitat, words: Array) -> Bodies:
    """Return fresh bodies from random words uint32 (N, words). It must be compiled everywhere.

    Operation by operation, a product and a sum are each rounded; compiled, they may be rounded once. On a
    CPU they may also be rounded otherwise for other N, since one body is no vector: there each is made
    by itself, so that bits do not depend on how many are born together.
    """

    def one(words: Array) -> Bodies:
        return jax.tree.map(lambda leaf: leaf[0], habitat.reset(words[None]))

    return lax.platform_dependent(words, cpu=partial(lax.map, one), default=habitat.reset)


def unborn(habitat: JaxHabitat, cells: int) -> Bodies:
    """Return what stands in cells before the first birth: copies of one body, made from zeros."""
    one = shared(fresh, habitat)(np.zeros((1, habitat.words), np.uint32))
    return jax.tree.map(lambda leaf: jnp.repeat(leaf, cells, axis=0), one)


def put(bodies: Bodies, cells: Array, made: Bodies) -> Bodies:
    """Return bodies with those made (K, ...) in cells int32 (K,); a cell out of range takes none."""
    return jax.tree.map(lambda all_, new: all_.at[cells].set(new, mode="drop"), bodies, made)


def choose(cells: Array, yes: Bodies, no: Bodies) -> Bodies:
    """Return bodies `yes` where cells, bool (C,), is true, and `no` elsewhere."""

    def leaf(a: Array, b: Array) -> Array:
        return jnp.where(cells.reshape(-1, *[1] * (a.ndim - 1)), a, b)

    return jax.tree.map(leaf, yes, no)


def broken(bodies: Bodies) -> Array:
    """Return which bodies have a coordinate that is not finite: bool (C,), or () if none can have one."""
    leaves = [leaf for leaf in jax.tree.leaves(bodies) if jnp.issubdtype(leaf.dtype, jnp.floating)]
    flat = [(~jnp.isfinite(leaf.reshape(len(leaf), -1))).any(axis=1) for leaf in leaves]
    return jnp.stack(flat).any(axis=0) if flat else jnp.zeros((), bool)
