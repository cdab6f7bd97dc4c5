"""Where a run stands, and when its worlds stop: what both kinds of chunks share.

A chunk is many ticks of law and habitat between two visits of the host. It may have any length: no life
depends on it.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from primordia.habitats.contract import Bodies
from primordia.law.law import Law
from primordia.law.population import quiet_ticks
from primordia.law.world import World, Worlds
from primordia.random.wide import Wide, happened


class Limits(NamedTuple):
    """When each world stops, for now: Wide (W,), `wide.never` for no limit."""

    ticks: Wide
    births: Wide
    saturation: Array
    """bool (): stop a world once it is saturated"""


class State(NamedTuple):
    """Where a run stands: all of it, for a habitat in JAX."""

    world: World
    bodies: Bodies


def running(worlds: Worlds, limits: Limits) -> Array:
    """Which worlds have not come to a limit, bool (W,). The others are frozen as they stand."""
    over = worlds.tick.at_least(limits.ticks) | worlds.births.at_least(limits.births)
    return ~(over | (limits.saturation & happened(worlds.saturated)))


def named_leaves(tree: object) -> list[tuple[str, Array]]:
    """The arrays of a state with their paths, such as `world.organisms.genome.input`."""
    leaves = jax.tree_util.tree_flatten_with_path(tree)[0]
    return [(jax.tree_util.keystr(path, simple=True, separator="."), leaf) for path, leaf in leaves]


def ticks_left(law: Law, world: World, limits: Limits, live_worlds: Array) -> Array:
    """Ticks until a limit or something else falls due in a running world, int32 ()."""
    to_limit = jnp.where(live_worlds, world.worlds.tick.until(limits.ticks), 2**31 - 1).min()
    return jnp.minimum(to_limit, quiet_ticks(law, world, live_worlds))
