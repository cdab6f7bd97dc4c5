"""The layout of a genome: the names, shapes and order of its blocks of weights."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import TypeAlias, TypeVar

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.errors import InputError

Shape: TypeAlias = tuple[int, ...]
Arrays = TypeVar("Arrays", Array, np.ndarray)

NAME = "[A-Za-z0-9_-]+"
"""Regular expression of a block's name, which becomes a part of names of settings and columns."""
BODY = "body"
"""The block of a body's genes; see `habitats.traits`."""


@dataclass(frozen=True)
class Layout:
    """Name and shape of each block of weights, in the order of the flat genome.

    Raises:
        InputError: there is no block, or one has a name or a shape that cannot be used.
    """

    blocks: tuple[tuple[str, Shape], ...]
    genes: int = 0
    """the number of a body's genes, in a last block BODY; 0 if bodies are not inherited"""

    def __post_init__(self) -> None:
        if not self.blocks:
            raise InputError("brain: blocks() names no blocks of weights, so nothing could evolve")
        for name, shape in self.blocks:
            if not isinstance(name, str) or not re.fullmatch(NAME, name):
                raise InputError(
                    f"brain: {name!r} cannot name a block of weights; use letters, digits, _ and -"
                )
            if not isinstance(shape, tuple) or not shape or not all(map(_is_axis, shape)):
                raise InputError(
                    f"brain: block {name!r} has the shape {shape!r}; use a tuple of positive integers"
                )

    @cached_property
    def names(self) -> list[str]:
        """Names of the blocks, B of them."""
        return [name for name, _ in self.blocks]

    @cached_property
    def sizes(self) -> np.ndarray:
        """Number of weights in each block, int64 (B,)."""
        return np.array([prod(shape) for _, shape in self.blocks], np.int64)

    @property
    def length(self) -> int:
        """P, the number of weights of one organism."""
        return int(self.sizes.sum())

    def with_body(self, genes: int) -> "Layout":
        """Return the layout with this number of genes of a body, after the blocks of a brain.

        Raises:
            InputError: a brain uses the block's name for weights.
        """
        if BODY in self.names:
            raise InputError(
                f"brain: its block {BODY!r} has the name of the block of a body's genes; rename it,"
                " or remove habitat.traits"
            )
        return Layout((*self.blocks, (BODY, (genes,))), genes)

    def flat(self, genome: Mapping[str, Array], cells: Array) -> Array:
        """Return the flat genomes of the organisms in some cells, (K, P).

        Args:
            genome: block of weights -> (C, *shape).
            cells: the organisms' cells, int32 (K,).
        """
        blocks = [genome[name][cells].reshape(len(cells), -1) for name in self.names]
        return jnp.concatenate(blocks, axis=1)

    def per_weight(self, per_block: Array) -> Array:
        """Repeat the value of each block for each of its weights: (K, B) -> (K, P)."""
        # With `jnp.repeat` a world with many births is a quarter slower.
        columns = jnp.split(per_block, len(self.sizes), axis=1)
        repeated = zip(columns, self.sizes, strict=True)
        return jnp.concatenate([jnp.repeat(each, size, axis=1) for each, size in repeated], axis=1)

    def split(self, flat: Arrays) -> dict[str, Arrays]:
        """Cut flat genomes (..., P) into blocks (..., *shape), in NumPy or JAX like the input."""
        library = np if isinstance(flat, np.ndarray) else jnp
        parts = library.split(flat, np.cumsum(self.sizes)[:-1], axis=-1)
        return {
            name: part.reshape(*flat.shape[:-1], *shape)
            for (name, shape), part in zip(self.blocks, parts, strict=True)
        }

    def join(self, genome: Mapping[str, np.ndarray]) -> np.ndarray:
        """Lay blocks (N, *shape) flat on the host: (N, P)."""
        parts = zip(self.names, self.sizes, strict=True)
        return np.concatenate([genome[name].reshape(-1, size) for name, size in parts], axis=1)


def _is_axis(length: object) -> bool:
    return type(length) is int and length > 0
