"""Seats of games: the inputs of a game, and the record of a stretch of its ticks."""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.law.genesis import words_of
from primordia.law.law import Law
from primordia.law.life import Vitals
from primordia.law.metabolism import Rates, to_fixed_point
from primordia.organism.mind import Mind
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, wide

ODD = np.array([0x9E3779B1, 0x85EBCA77], np.uint32)
"""Odd numbers that mix the bits of senses."""

Script = Callable[[int], np.ndarray]
"""The actions of all games at a tick: int32 (N,) or float32 (N, A)"""


class Frozen(NamedTuple):
    """The inputs of N players, senses and memory, whose values stay as at the start of a game."""

    senses: np.ndarray
    """bool (N, S)"""
    memory: np.ndarray
    """bool (N, 1): whether the memory is frozen; a frozen memory stays all zeros, as at the start"""

    def take(self, index: Any) -> "Frozen":
        """Return the rows at an index."""
        return Frozen(self.senses[index], self.memory[index])


class Manner(NamedTuple):
    """The manner in which N games are played."""

    ticks: int
    """length at which games are cut"""
    frozen: Frozen | None = None
    script: Script | None = None
    """actions that are repeated regardless of senses"""
    watched: bool = False
    """whether stretches record the brains' inputs"""


class Stretch(NamedTuple):
    """T ticks of N games."""

    playing: np.ndarray
    """bool (T, N): whether a game goes on when a tick begins"""
    action: np.ndarray
    """int32 (T, N) or float32 (T, N, A)"""
    food: np.ndarray | None
    """float32 (T, N)"""
    mark: np.ndarray
    """uint32 (T, N, 2): a hash of the senses when a tick begins"""
    alive: np.ndarray
    """bool (N,): which games go on after the last tick"""
    met: "Thinking | None" = None
    """the brains' inputs, if they are recorded"""


class Thinking(NamedTuple):
    """The inputs of N brains in T ticks, before any input is frozen."""

    senses: Any
    """float32 (T, N, S)"""
    memory: Any
    """float32 (T, N, M)"""


class Seats(NamedTuple):
    """N players of one game each, as NumPy arrays."""

    genomes: np.ndarray
    """float32 (N, P)"""
    keys: Wide
    """(N,), key of everything random in a game"""
    cells: np.ndarray
    """int32 (N,): number that distinguishes the games of one key"""
    rates: Rates
    """metabolism, each float32 (N,)"""


def mark(senses: Any) -> Any:
    """Return a hash of senses float32 (N, S), on the host or in JAX: uint32 (N, 2)."""
    places = np.arange(1, senses.shape[1] + 1, dtype=np.uint32)
    factors = (2 * places[:, None] + 1) * ODD
    return (senses.view(np.uint32)[:, :, None] * factors).sum(axis=1, dtype=np.uint32)


def begun(law: Law, words: int, seated: Seats) -> tuple[Mind, Array, Vitals, Array]:
    """Return games at their start; `words` is the number of random words of each body.

    Returns:
        mind; memory, float32 (N, M); vitals; random words of bodies, uint32 (N, words).
    """
    cells, store = jnp.asarray(seated.cells), to_fixed_point(seated.rates.store)
    mind = Mind(law.heredity.layout.split(jnp.asarray(seated.genomes)), seated.keys, cells)
    key = stream(seated.keys, Purpose.BODY, wide([0]))
    drawn = words_of(law, mind.genome, key, cells, words)
    memory = jnp.zeros((len(store), law.memory), jnp.float32)
    return mind, memory, Vitals(store, jnp.zeros_like(store)), drawn
