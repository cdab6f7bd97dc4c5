"""The state of a run and the limits of its worlds, which both kinds of chunks share.

A chunk is many ticks of law and habitat, after which the run records events. No life depends on
the length of chunks.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.errors import Trouble
from primordia.habitats.contract import Bodies
from primordia.law.law import Law
from primordia.law.population import quiet_ticks
from primordia.law.world import World, Worlds
from primordia.random.wide import Wide, happened

Tree = TypeVar("Tree")


class Limits(NamedTuple):
    """The limits at which each world stops, Wide (W,); `wide.never` means no limit."""

    ticks: Wide
    births: Wide
    saturation: Array
    """bool (): stop a world once it is saturated"""


class State(NamedTuple):
    """The state of a run; a habitat on the host holds a further part of the state itself."""

    world: World
    bodies: Bodies
    """for a habitat in JAX, the bodies; for a habitat on the host, the senses, float32 (C, S)"""


def running(worlds: Worlds, limits: Limits) -> Array:
    """Return which worlds have not reached a limit, bool (W,). The others are frozen."""
    over = worlds.tick.at_least(limits.ticks) | worlds.births.at_least(limits.births)
    return ~(over | (limits.saturation & happened(worlds.saturated)))


def named_leaves(tree: object) -> list[tuple[str, Array]]:
    """Return the arrays of a state with their paths, such as `world.organisms.genome.input`."""
    leaves = jax.tree_util.tree_flatten_with_path(tree)[0]
    return [(jax.tree_util.keystr(path, simple=True, separator="."), leaf) for path, leaf in leaves]


def copied(array: np.ndarray, device: Any = None) -> Array:
    """Return a copy of an array on a device, or JAX's default device; nothing is compiled for it.

    NumPy copies, since on the CPU `device_put` uses NumPy's memory even with `may_alias=False`.
    """
    return jax.device_put(np.array(array), device)


def filled(
    template: Tree,
    arrays: Mapping[str, np.ndarray],
    prefix: str = "",
    place: Callable[[np.ndarray], Array] = copied,
) -> Tree:
    """Return a tree like the template, but with stored arrays.

    The name of an array is `prefix` and the array's path in the tree.

    `place` copies an array from the host to its device.

    Raises:
        Trouble: an array is missing, or has another shape or type than the template's.
    """
    leaves = []
    for name, own in named_leaves(template):
        stored = arrays.get(prefix + name)
        if stored is None or (stored.shape, stored.dtype) != (own.shape, own.dtype):
            raise Trouble(
                f"the checkpoint does not fit this run: {prefix + name} is missing or different"
            )
        leaves.append(place(stored))
    return jax.tree.unflatten(jax.tree.structure(template), leaves)


def ticks_left(law: Law, world: World, limits: Limits, live_worlds: Array) -> Array:
    """Return the ticks until a running world reaches a limit or until a change is due, int32 ()."""
    to_limit = jnp.where(live_worlds, world.worlds.tick.until(limits.ticks), 2**31 - 1).min()
    return jnp.minimum(to_limit, quiet_ticks(law, world, live_worlds))
