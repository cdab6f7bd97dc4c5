"""Births, deaths and samples on their way from the law to the recorder.

Events are rare, so they leave a compiled chunk as compact lists, in the order (tick, world, cell):
never as masks of cells x ticks. None is dropped: a chunk ends before a list could overflow.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array, lax

BIRTH_FIELDS = ("cell", "id.hi", "id.lo", "parent.hi", "parent.lo", "tick.hi", "tick.lo", "cause")
DEATH_FIELDS = ("cell", "id.hi", "id.lo", "tick.hi", "tick.lo", "cause", "energy", "eaten")


class Rows(NamedTuple):
    """A list of events: uint32 (capacity, fields), of which the first `filled` are meant."""

    rows: Array
    filled: Array
    """int32 ()"""


class Events(NamedTuple):
    """What happened in a chunk."""

    births: Rows
    deaths: Rows
    samples: Rows


def batch(cells: int) -> int:
    """How many events are handled at a time: few where few happen in a tick, many for a GPU's sake."""
    return min(max(cells // 256, 1), 1024)


def empty(cells: int, worlds: int, sample_fields: int) -> Events:
    """Empty lists for C cells and W worlds, with room for several ticks' worth of events."""

    def rows(most_a_tick: int, least: int, fields: int) -> Rows:
        capacity = max(2 * most_a_tick, least) + batch(cells)
        return Rows(jnp.zeros((capacity, fields), jnp.uint32), jnp.int32(0))

    return Events(
        births=rows(cells, 1 << 15, len(BIRTH_FIELDS)),
        deaths=rows(cells, 1 << 15, len(DEATH_FIELDS)),
        samples=rows(worlds, 1 << 10, sample_fields),
    )


def emptied(events: Events) -> Events:
    """The same lists, to be filled anew."""
    return Events(*(rows._replace(filled=jnp.int32(0)) for rows in events))


def have_room(events: Events, cells: int, worlds: int) -> Array:
    """Whether one more tick's events fit, however many: bool ()."""
    spare = batch(cells)

    def fits(list_: Rows, most: int) -> Array:
        return list_.filled + most + spare <= len(list_.rows)

    return fits(events.births, cells) & fits(events.deaths, cells) & fits(events.samples, worlds)


def for_each(mask: Array, carry: tuple, act: Callable[[Array, Array, tuple], tuple]) -> tuple:
    """Call act(cells, valid, carry) for the true cells of a mask (C,), a batch at a time, in order.

    `cells` (K,) int32 and `valid` (K,): the last batch is filled up with cells not meant. The cost is
    per batch, beside one running sum over the mask.
    """
    rank = jnp.cumsum(mask, dtype=jnp.int32)
    slots = jnp.arange(batch(len(mask)), dtype=jnp.int32)

    def body(state: tuple[Array, tuple]) -> tuple[Array, tuple]:
        start, carry = state
        cells = jnp.searchsorted(rank, start + slots + 1, method="scan_unrolled").astype(jnp.int32)
        valid = start + slots < rank[-1]
        cells = jnp.minimum(cells, len(mask) - 1)
        return start + len(slots), act(cells, valid, carry)

    return lax.while_loop(lambda state: state[0] < rank[-1], body, (jnp.int32(0), carry))[1]


def append(list_: Rows, columns: list[Array], valid: Array) -> Rows:
    """Add a batch of rows given as columns (K,); those not valid will be written over."""
    block = jnp.stack([column.astype(jnp.uint32) for column in columns], axis=1)
    rows = lax.dynamic_update_slice(list_.rows, block, (list_.filled, jnp.int32(0)))
    return Rows(rows, list_.filled + valid.sum(dtype=jnp.int32))
