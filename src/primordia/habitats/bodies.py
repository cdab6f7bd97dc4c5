"""Bodies in JAX, inserted into cells, selected and checked for finite coordinates; actions for trials."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.compiled import shared
from primordia.habitats.archipelago import ArchipelagoInJax, Parts, joined, split
from primordia.habitats.contract import Action, Bodies, Continuous, Discrete, JaxHabitat
from primordia.random import trials

MADE = 32
"""Number of bodies that `fresh_bodies` makes. Each number would be compiled separately, which takes half
a minute for bodies of MJX."""


def fresh_bodies(habitat: JaxHabitat, words: np.ndarray) -> Bodies:
    """Return fresh bodies from words uint32 (MADE, words), outside a world."""
    return shared(type(habitat).reset, habitat)(words)


def random_actions(kind: Action, ticks: int, count: int) -> np.ndarray:
    """Return actions of trials, the same in every call, for each tick and body: (ticks, count, ...)."""
    if isinstance(kind, Discrete):
        return (trials.words(1, ticks, count) % np.uint32(kind.size)).astype(np.int32)
    if isinstance(kind, Continuous):
        return trials.normal(1, ticks, count, kind.size)
    drawn, at = trials.normal(1, ticks, count, kind.columns), 0
    columns = trials.words(2, ticks, count, kind.columns)
    for part in kind.parts:
        if isinstance(part, Discrete):
            drawn[..., at] = columns[..., at] % np.uint32(part.size)
        at += 1 if isinstance(part, Discrete) else part.size
    return drawn


def placeholder_bodies(habitat: JaxHabitat, cells: int) -> Bodies:
    """Return the bodies of cells before the first birth: copies of one body that is made from zeros."""
    if isinstance(habitat, ArchipelagoInJax):
        sizes = habitat.islands.sizes
        each = zip(habitat.habitats, sizes, strict=True)
        worlds = cells // sum(sizes)
        return Parts(tuple(placeholder_bodies(own, worlds * size) for own, size in each), sizes)
    made = fresh_bodies(habitat, np.zeros((MADE, habitat.words), np.uint32))
    return jax.tree.map(partial(_copies_of_first, cells), made)


def _copies_of_first(cells: int, leaf: Array) -> Array:
    """Return copies of the first body's array: by NumPy outside of compiled code, where JAX would
    compile them for each shape."""
    if isinstance(leaf, jax.core.Tracer):
        return jnp.repeat(leaf[:1], cells, axis=0)
    return jax.device_put(np.repeat(np.asarray(leaf)[:1], cells, axis=0))


def insert_bodies(bodies: Bodies, cells: Array, new: Bodies) -> Bodies:
    """Return bodies with `new` ones (K, ...) in cells int32 (K,); cells out of range are left out."""
    return jax.tree.map(lambda old, leaf: old.at[cells].set(leaf, mode="drop"), bodies, new)


def select_bodies(mask: Array, yes: Bodies, no: Bodies) -> Bodies:
    """Return each cell's body: from `yes` where the mask, bool (C,), is true, else from `no`."""
    if isinstance(yes, Parts):
        each = zip(split(mask, yes.sizes), yes.island, no.island, strict=True)
        return Parts(tuple(select_bodies(*own) for own in each), yes.sizes)

    def select_leaf(a: Array, b: Array) -> Array:
        return jnp.where(mask.reshape(-1, *[1] * (a.ndim - 1)), a, b)

    return jax.tree.map(select_leaf, yes, no)


def not_finite(bodies: Bodies) -> Array:
    """Return which bodies have a coordinate that is not finite: bool (C,), or () if all are integers."""
    if isinstance(bodies, Parts):
        counts = [len(jax.tree.leaves(own)[0]) for own in bodies.island]
        each = zip(map(not_finite, bodies.island), counts, strict=True)
        return joined([jnp.broadcast_to(found, count) for found, count in each], bodies.sizes)
    leaves = [leaf for leaf in jax.tree.leaves(bodies) if jnp.issubdtype(leaf.dtype, jnp.floating)]
    flat = [(~jnp.isfinite(leaf.reshape(len(leaf), -1))).any(axis=1) for leaf in leaves]
    return jnp.stack(flat).any(axis=0) if flat else jnp.zeros((), bool)
