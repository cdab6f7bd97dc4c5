"""Chunks on several devices, each of which holds an equal number of a run's worlds.

Worlds share nothing. So every device has a loop for its own worlds, with its own lists of events,
and waits for the others only at the end of a chunk. If a list is full on one device, the worlds of
this device are behind all other worlds for a while. A state is the same as on one device, but each
array of the state is split along the first axis.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.sharding import Mesh, NamedSharding, PartitionSpec

from primordia.compiled import shared
from primordia.engine.fused import FusedChunks, advance
from primordia.engine.state import Limits, State, copied, filled
from primordia.habitats.bodies import placeholder_bodies
from primordia.habitats.contract import Bodies, JaxHabitat
from primordia.law import events as log
from primordia.law.columns import Columns
from primordia.law.events import BIRTHS, DEATHS, Events, Rows, sample_columns
from primordia.law.genesis import empty_worlds
from primordia.law.law import Law
from primordia.random.wide import wide
from primordia.rounding import rounded

AXIS = "devices"
SPLIT: Any = PartitionSpec(AXIS)
"""an array whose first axis is split over the devices"""
SAME: Any = PartitionSpec()
"""an array that is copied to all devices"""


class ShardedChunks(FusedChunks):
    """Law and habitat in one compiled loop on each device, for its share of the worlds."""

    def __init__(self, law: Law, habitat: JaxHabitat, devices: list[jax.Device]) -> None:
        """Use `devices`; their number must divide the number of worlds."""
        self._law, self._habitat = law, habitat
        self._share = replace(law, worlds=law.worlds // len(devices))
        mesh = Mesh(np.array(devices), (AXIS,))
        self._split = NamedSharding(mesh, SPLIT)
        self._advance = shared(_advance, mesh, self._share.compiled, habitat, donate=(0, 1))
        self._lists: Events = shared(_empty, mesh, self._share)()
        self.events = self._joined()

    def begin(self, seeds: np.ndarray) -> State:
        """Return the state of a run before genesis; no device holds more than its share."""
        world = jax.device_put(empty_worlds(self._law, wide(seeds)), self._split)
        return State(world, shared(_bodies, self._split.mesh, self._share, self._habitat)())

    def advance(self, state: State, limits: Limits, ticks: int) -> tuple[State, int]:
        """Advance by at most `ticks`, fewer if every world stops or the lists are full.

        Returns:
            state; the number of ticks advanced on the device that advanced most.
        """
        # A state that is split already is not copied.
        state = jax.device_put(state, self._split)
        state, self._lists, done = self._advance(state, self._lists, limits, np.int32(ticks))
        self.events = self._joined()
        return state, int(np.asarray(done).max())

    def load(self, template: State, arrays: dict[str, np.ndarray]) -> State:
        """Return the state that `save` stored; `template` is any state of the same run."""
        return filled(template, arrays, place=partial(copied, device=self._split))

    def _joined(self) -> Events:
        """Return the events of all devices, with cells and worlds numbered as in the whole run."""
        cells, worlds = self._share.worlds * self._share.cells, self._share.worlds
        births, deaths, samples = self._lists
        return Events(
            births=_joined(births, BIRTHS, cells),
            deaths=_joined(deaths, DEATHS, cells),
            samples=_joined(samples, sample_columns(()), worlds),
        )


def _joined(lists: Rows, columns: Columns, share: int) -> Rows:
    """Join the devices' lists into one, in the order of ticks; rows of the same tick stay in order.

    Args:
        lists: rows uint32 (D, capacity, fields), filled int32 (D,).
        columns: the first columns of a row; the very first is the number of a cell or of a
            world within a device.
        share: the number of cells or worlds of a device.
    """
    parts = [np.zeros((0, lists.rows.shape[2]), np.uint32)]
    for device, count in enumerate(np.asarray(lists.filled)):
        rows = np.asarray(lists.rows.addressable_shards[device].data)[0, :count].copy()
        rows[:, 0] += np.uint32(device * share)
        parts.append(rows)
    joined = np.concatenate(parts)
    in_order: Any = joined[np.argsort(columns.unpacked(joined)["tick"], kind="stable")]
    return Rows(in_order, jnp.int32(len(joined)))


def _on_each(mesh: Mesh, function: Callable, *given: PartitionSpec | tuple) -> Callable:
    """Return a function that calls `function` on each device with that device's share of the
    arguments."""
    return jax.shard_map(function, mesh=mesh, in_specs=given, out_specs=SPLIT, check_vma=False)


def _bodies(mesh: Mesh, law: Law, habitat: JaxHabitat) -> Bodies:
    return _on_each(mesh, lambda: placeholder_bodies(habitat, law.worlds * law.cells))()


def _empty(mesh: Mesh, law: Law) -> Events:
    return _on_each(mesh, lambda: _of_device(log.empty(law, jnp)))()


def _advance(
    mesh: Mesh,
    law: Law,
    habitat: JaxHabitat,
    state: State,
    events: Events,
    limits: Limits,
    ticks: Array,
) -> tuple[State, Events, Array]:
    """Advance the worlds of every device as `fused.advance` does; `law` is that of one device."""

    def on_one(state: State, events: Events, *most: Any) -> tuple[State, Events, Array]:
        events = jax.tree.map(lambda leaf: leaf[0], events)
        state, events, done = advance(law, habitat, state, events, *most)
        return state, *_of_device((events, done))

    limited = Limits(SPLIT, SPLIT, SAME)
    on_all = _on_each(mesh, rounded(on_one), SAME, SPLIT, SPLIT, limited, SAME)
    zero = (ticks >> np.int32(31)).astype(jnp.uint32)  # the compiler knows no sign of an argument
    return on_all(zero, state, events, limits, ticks)


_of_device = partial(jax.tree.map, lambda leaf: leaf[None])
"""Give the arrays of a device a first axis, along which the arrays of all devices are joined."""
