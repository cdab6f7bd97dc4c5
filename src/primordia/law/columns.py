"""Columns of the lists that the law writes and that records keep; rows are packed and unpacked by name.

A row is made of uint32 words. A 64-bit number takes two words, the high word first.
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
    """names of the columns of 64 bits"""

    @property
    def width(self) -> int:
        """Number of words in a row."""
        return len(self.names) + len(self.pairs)

    def words(self, **values: Array | Wide) -> Array:
        """Return rows from the values of all columns by name, uint32 (K, width) from (K,).

        Signed integers and float32 numbers keep their bits.
        """
        assert set(values) == set(self.names)
        words: list[Array] = []
        for name in self.names:
            value = values[name]
            words += list(value) if isinstance(value, tuple) else [_word(value)]
        return jnp.stack(words, axis=1)

    def rows(self, **values: np.ndarray) -> np.ndarray:
        """Return the rows of `words` as a NumPy array; each pair is given as one int64 or uint64."""
        assert set(values) == set(self.names)
        words: list[np.ndarray] = []
        for name in self.names:
            value = values[name]
            words += [value >> 32, value] if name in self.pairs else [value]
        return np.stack(words, axis=1).astype(np.uint32)

    def unpacked(self, rows: np.ndarray) -> dict[str, np.ndarray]:
        """Return the columns of rows: int64 for pairs, otherwise uint32, (K,) from (K, width)."""
        columns, word = {}, 0
        for name in self.names:
            if name in self.pairs:
                high, low = rows[:, word].astype(np.int64), rows[:, word + 1].astype(np.int64)
                columns[name] = high << 32 | low
                word += 2
            else:
                columns[name] = np.ascontiguousarray(rows[:, word])
                word += 1
        return columns

    def plus(self, *names: str, pairs: tuple[str, ...] = ()) -> "Columns":
        """Return these columns, followed by `names`; the `pairs` among `names` have 64 bits."""
        return Columns((*self.names, *names), self.pairs.union(pairs))


def _word(value: Array) -> Array:
    """Return 32-bit numbers as words with the same bits."""
    if value.dtype == jnp.float32:
        return lax.bitcast_convert_type(value, jnp.uint32)
    return value.astype(jnp.uint32)
