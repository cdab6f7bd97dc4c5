"""Births, deaths and samples on their way from the law to the recorder.

Events are rare, so they leave a compiled chunk as compact lists, in the order (tick, world, cell),
never as masks of cells x ticks. No event is dropped: a chunk ends before a list could overflow.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.law.columns import Columns
from primordia.law.law import Law
from primordia.law.world import Cause

BIRTHS = Columns(("cell", "id", "parent", "tick", "cause"), frozenset({"id", "parent", "tick"}))
"""Columns of all births. 2^64 - 1 stands in place of a founder's parent or a missing mate."""
DEATHS = Columns(("cell", "id", "tick", "cause", "energy", "food"), frozenset({"id", "tick"}))
"""Columns of a death."""
TOTALS = (
    "tick",
    "births",
    *(f"deaths_{cause.name.lower()}" for cause in Cause),
    "extinctions",
    "organism_ticks",
    "age_total",
    "oldest_age",
    "energy_total",
    "food_total",
)
"""Names of the 64-bit values in a sample. Births, deaths, extinctions, organism-ticks and food are
counted since the beginning of the world; the other totals are over the living. Energy and food are
in 1/1024 units, two's complement."""


def birth_columns(mates: bool, notes: tuple[str, ...], endowed: bool = False) -> Columns:
    """Return the columns of a birth: the common ones, the mate if there are mates, the endowment if
    parents pay one, and the notes."""
    own = ("mate",) if mates else ()
    return BIRTHS.plus(*own, *(("endowment",) if endowed else ()), *notes, pairs=own)


def births_of(law: Law) -> Columns:
    """Return the columns of births under a law."""
    mates = law.heredity.recombination is not None
    return birth_columns(mates, law.heredity.mutation.notes, law.act is not None)


def sample_columns(rates: tuple[str, ...]) -> Columns:
    """Return the columns of a sample: counts, and the settings that seasons may change (float32)."""
    return Columns(("world", "population", *TOTALS, *rates), frozenset(TOTALS))


class Rows(NamedTuple):
    """A list of events. The first `filled` of its rows are valid; uint32 (capacity, fields)."""

    rows: Array
    filled: Array
    """int32 ()"""


class Events(NamedTuple):
    """The births, deaths and samples of a chunk."""

    births: Rows
    deaths: Rows
    samples: Rows


def batch(cells: int) -> int:
    """Return the number of events in a batch: 1 in small worlds, up to 1,024 in large ones (for GPUs)."""
    return min(max(cells // 256, 1), 1024)


def empty(law: Law, library: Any = np) -> Events:
    """Return empty lists, with room for the events of several ticks.

    The library is NumPy, since JAX would compile code for each shape, or JAX's NumPy in compiled code.
    """
    cells = law.worlds * law.cells

    def empty_list(most_per_tick: int, least: int, columns: Columns) -> Rows:
        capacity = max(2 * most_per_tick, least) + batch(cells)
        rows = library.zeros((capacity, columns.width), np.uint32)
        return Rows(rows, library.zeros((), np.int32))

    lists = Events(
        births=empty_list(cells, 1 << 15, births_of(law)),
        deaths=empty_list(cells, 1 << 15, DEATHS),
        samples=empty_list(law.worlds, 1 << 10, sample_columns(law.rates)),
    )
    return jax.device_put(lists)


def emptied(events: Events) -> Events:
    """Return the lists without their events."""
    return Events(*(rows._replace(filled=jnp.int32(0)) for rows in events))


def have_room(law: Law, events: Events) -> Array:
    """Return whether the lists have room for the largest number of events in a tick: bool ()."""
    cells = law.worlds * law.cells
    spare = batch(cells)

    def fits(list_: Rows, most: int) -> Array:
        return list_.filled + most + spare <= len(list_.rows)

    return (
        fits(events.births, cells) & fits(events.deaths, cells) & fits(events.samples, law.worlds)
    )


def for_each(mask: Array, carry: tuple, act: Callable[[Array, Array, tuple], tuple]) -> tuple:
    """Call act(cells, valid, carry) for the true cells of a mask (C,), a batch at a time, in order.

    Args:
        mask: bool (C,).
        carry: passed to the first call of `act`, and from each call to the next.
        act: takes cells, int32 (K,), a mask of the valid cells, bool (K,), and the carry; returns
            the carry. The last batch is padded with cells that are not valid.

    Returns:
        carry after the last batch. The cost is one running sum over the mask, and one call for each
        batch.
    """
    rank = jnp.cumsum(mask, dtype=jnp.int32)
    slots = jnp.arange(batch(len(mask)), dtype=jnp.int32)
    # In small worlds, comparing all ranks is as fast as a binary search, and compiles faster.
    method = "compare_all" if len(slots) == 1 else "scan_unrolled"

    def body(state: tuple[Array, tuple]) -> tuple[Array, tuple]:
        start, carry = state
        cells = jnp.searchsorted(rank, start + slots + 1, method=method).astype(jnp.int32)
        valid = start + slots < rank[-1]
        cells = jnp.minimum(cells, len(mask) - 1)
        return start + len(slots), act(cells, valid, carry)

    return lax.while_loop(lambda state: state[0] < rank[-1], body, (jnp.int32(0), carry))[1]


def append(list_: Rows, block: Array, valid: Array) -> Rows:
    """Append a batch of rows, uint32 (K, fields). The next batch overwrites rows that are not valid."""
    rows = lax.dynamic_update_slice(list_.rows, block, (list_.filled, jnp.int32(0)))
    return Rows(rows, list_.filled + valid.sum(dtype=jnp.int32))
