"""Games in a habitat in JAX, played many ticks at a time in one compiled loop."""

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.habitats.contract import Bodies, JaxHabitat
from primordia.law.law import Law
from primordia.law.life import Vitals, judge
from primordia.law.metabolism import Rates
from primordia.organism.mind import Mind, perceiver, think
from primordia.organism.playing.seats import (
    Frozen,
    Manner,
    Seats,
    Stretch,
    Thinking,
    begun,
    mark,
)
from primordia.random.wide import Wide, wide

STRETCH = 64
"""Ticks of one compiled loop."""
FEWEST = 16
"""Smallest number of games of a loop. Loops are padded, since JAX compiles for every new shape."""
FEWER = 8
"""Games that are over leave the loop when at most one game in this many still goes on."""


class _Table(NamedTuple):
    """The inputs of the loop for N games."""

    mind: Mind
    rates: Rates
    frozen: Frozen | None
    first: Array | None
    """the senses at the start, float32 (N, S), if any sense is frozen"""
    bodies: Bodies
    memory: Array
    vitals: Vitals
    alive: Array
    """bool (N,)"""


def stretches(
    law: Law,
    habitat: JaxHabitat,
    seated: Seats,
    manner: Manner,
) -> Iterator[Stretch]:
    """Play games, STRETCH ticks at a time; see `games.play`."""
    count = len(seated.genomes)
    rows = np.arange(count)
    seats, frozen = _padded((seated, manner.frozen), 1 << (count - 1).bit_length())
    table = _opened(law, habitat, seats, frozen, count)
    advance, script = shared(_advance, law, habitat, manner.watched), manner.script
    for begin in range(0, manner.ticks, STRETCH):
        numbers, size = np.arange(begin + 1, begin + STRETCH + 1), len(table.alive)
        actions = script and np.stack([_padded(script(int(tick))[rows], size) for tick in numbers])
        now = wide(numbers[:, None]), numbers <= manner.ticks, actions
        table, lived = advance(table, now)
        alive = np.asarray(table.alive)[: len(rows)]
        shown = jax.tree.map(partial(_in_full, rows=rows, count=count), lived)
        playing, action, food, marks, met = shown
        goes_on = np.isin(np.arange(count), rows[alive])
        yield Stretch(playing, action, food, marks, goes_on, met)
        if 0 < FEWER * alive.sum() <= size > FEWEST:
            rows = rows[alive]
            table = _left(table, _padded(np.flatnonzero(alive), size // FEWER), len(rows))


def _opened(
    law: Law, habitat: JaxHabitat, seated: Seats, frozen: Frozen | None, count: int
) -> _Table:
    """Return the table at the start of `count` games; further games are padding."""
    mind, memory, vitals, words = shared(begun, law, habitat.words)(seated)
    bodies = shared(type(habitat).reset, habitat)(words)
    first = None
    if frozen is not None:
        first = perceiver(law)(shared(type(habitat).sense, habitat)(bodies), vitals.energy)
    alive = np.arange(len(seated.genomes)) < count
    return _Table(mind, seated.rates, frozen, first, bodies, memory, vitals, jnp.asarray(alive))


def _padded(tree: Any, size: int) -> Any:
    """Repeat the last row of each leaf (N, ...) until it has `size` rows, at least FEWEST."""

    def longer(leaf: np.ndarray) -> np.ndarray:
        more = max(size, FEWEST) - len(leaf)
        return np.pad(leaf, [(0, more)] + [(0, 0)] * (leaf.ndim - 1), mode="edge")

    return jax.tree.map(longer, tree)


def _in_full(part: Array, rows: np.ndarray, count: int) -> np.ndarray:
    """Return T ticks of all games: the first rows of a part (T, N, ...), then zeros."""
    whole = np.zeros((len(part), count, *part.shape[2:]), part.dtype)
    whole[:, rows] = np.asarray(part)[:, : len(rows)]
    return whole


@jax.jit
def _left(table: _Table, index: Array, count: int) -> _Table:
    """Return the table with the games at an index (N,), of which the first `count` go on."""
    table = jax.tree.map(lambda leaf: leaf[index], table)
    return table._replace(alive=table.alive & (jnp.arange(len(index)) < count))


def _advance(
    law: Law,
    habitat: JaxHabitat,
    watched: bool,
    table: _Table,
    ticks: tuple[Wide, Array, Array | None],
) -> tuple[_Table, tuple]:
    """Play T ticks in a loop.

    `ticks` holds their numbers (T, 1), whether they count (T,), and their actions or None.
    """
    mind, rates, frozen, first, *own = table

    def play(own: tuple, now: tuple[Wide, Array, Array | None]) -> tuple[tuple, tuple]:
        bodies, memory, vitals, alive = own
        tick, counts, action = now
        senses, faulty, spent = habitat.sense(bodies), jnp.zeros_like(alive), None
        perceived = law.perceived(senses, vitals.energy)
        met = Thinking(perceived, memory) if watched else None
        if action is None:
            seen, kept = perceived, memory
            if frozen is not None and first is not None:
                seen = jnp.where(frozen.senses, first, perceived)
                kept = jnp.where(frozen.memory, 0, memory)
            thought = think(law, mind, kept, seen, tick)
            memory, action, faulty, spent, _ = thought
        bodies, outcome = habitat.step(bodies, action)
        vitals, cause = judge(law, vitals, faulty, bodies, outcome, rates, spent)
        playing = alive & counts
        lived = playing, action, outcome.food, mark(senses), met
        return (bodies, memory, vitals, alive & ~(playing & (cause >= 0))), lived

    own_after, lived = lax.scan(play, tuple(own), ticks)
    return _Table(mind, rates, frozen, first, *own_after), lived
