"""Senses and state of a body in few arrays, since one array for each number doubled a tick's time."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

WORDS = (np.float32, np.int32, np.uint32)
"""Types whose numbers are one word of 32 bits; a truth value is also one word."""


class Packed(NamedTuple):
    """Senses and state of one body, or of N bodies with a further first axis."""

    words: Array
    """uint32 (K,): the bits of the senses, then of the state's single numbers"""
    arrays: list[Array]
    """the rest of the state"""

    def senses(self, size: int) -> Array:
        """Return the senses (..., size)."""
        return lax.bitcast_convert_type(self.words[..., :size], jnp.float32)

    def state(self, senses_size: int, template: Any) -> Any:
        """Return one body's state, a tree with the template's form."""
        leaves, form = jax.tree.flatten(template)
        words, arrays = iter(self.words[senses_size:]), iter(self.arrays)
        state = [
            _number(next(words), leaf.dtype) if _is_word(leaf) else next(arrays) for leaf in leaves
        ]
        return jax.tree.unflatten(form, state)


def pack(senses: Array, state: Any) -> Packed:
    """Return one body's senses, float32 (S,), and state, packed."""
    leaves = jax.tree.leaves(state)
    words = [_word(leaf)[None] for leaf in leaves if _is_word(leaf)]
    arrays = [leaf for leaf in leaves if not _is_word(leaf)]
    return Packed(jnp.concatenate([_word(senses), *words]), arrays)


def _is_word(leaf: Any) -> bool:
    return not leaf.shape and leaf.dtype in (*WORDS, np.bool_)


def _word(value: Array) -> Array:
    if value.dtype == bool:
        return value.astype(jnp.uint32)
    return lax.bitcast_convert_type(value, jnp.uint32)


def _number(word: Array, dtype: Any) -> Array:
    return word.astype(dtype) if dtype == np.bool_ else lax.bitcast_convert_type(word, dtype)
