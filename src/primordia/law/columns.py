"""Columns of the lists that the law writes and records keep: named once, packed and unpacked by name.

A row is made of uint32 words. A 64-bit number takes two, high word first.
"""

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.random.wide import Wide


@dataclass(frozen=True)
class Columns:
    """Names of a list's columns, in order."""

    names: tuple[str, ...]
    pairs: frozenset[str] = frozenset()
    """those of 64 bits"""

    @property
    def width(self) -> int:
        """Words of a row."""
        return len(self.names) + len(self.pairs)

    def words(self, **values: Array | Wide) -> Array:
        """Return rows uint32 (K, width) of the values (K,) of all columns, by name.

        Signed integers keep their bits, and so do float32 numbers.
        """
        assert set(values) == set(self.names)
        words: list[Array] = []
        for name in self.names:
            value = values[name]
            words += list(value) if isinstance(value, tuple) else [_word(value)]
        return jnp.stack(words, axis=1)

    def rows(self, **values: np.ndarray) -> np.ndarray:
        """Return the same on the host, of integers (K,); those of 64 bits are int64 or uint64."""
        assert set(values) == set(self.names)
        halves = (
            (value >> 32, value) if name in self.pairs else (value,)
            for name, value in ((name, values[name]) for name in self.names)
        )
        return np.stack([half for each in halves for half in each], axis=1).astype(np.uint32)

    def of(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Return the columns of rows uint32 (K, width): int64 for pairs, else uint32 words, (K,)."""
        found, place = {}, 0
        for name in self.names:
            if name in self.pairs:
                high, low = rows[:, place].astype(np.int64), rows[:, place + 1].astype(np.int64)
                found[name] = high << 32 | low
            else:
                found[name] = np.ascontiguousarray(rows[:, place])
            place += 1 + (name in self.pairs)
        return found

    def plus(self, *names: str) -> "Columns":
        """Return these columns and further ones of 32 bits after them."""
        return Columns((*self.names, *names), self.pairs)


def _word(value: Array) -> Array:
    """Return 32-bit numbers as words, to the bit."""
    if value.dtype == jnp.float32:
        return lax.bitcast_convert_type(value, jnp.uint32)
    return value.astype(jnp.uint32)
