"""Recombination: a child takes some of its weights from a second parent, the mate.

The mate is drawn among the living neighbours of the child's cell, the parent excluded. On a ring the
mate is the neighbour on the other side. A child without a neighbour other than the parent has no
mate. The mate is recorded with the birth, so that genomes are rebuilt through both lines.
"""

from typing import Literal

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.brains.layout import Layout
from primordia.mutations.contract import Draws
from primordia.random.keys import Purpose, below, bits, chance
from primordia.random.wide import Wide
from primordia.settings.base import Settings


class Recombination(Settings):
    """The exchange of weights between parent and mate. Recombination precedes mutation."""

    probability: float = Field(
        1.0,
        ge=0,
        le=1,
        description="probability that a child has two parents, if its cell has another living neighbour",
    )
    unit: Literal["block", "row"] = Field(
        "row",
        description="unit that comes from one parent as a whole: a block of weights, or a row of a block",
    )

    def recombined(self, layout: Layout, draws: Draws, parents: Array, mates: Array) -> Array:
        """Return genomes float32 (K, P); each unit comes from either parent with the same
        probability.

        A row is the part of a block at one index of its first axis. A row holds the weights into one
        neuron if the layer has more inputs than neurons; otherwise, and in square blocks such as
        recurrent weights, those out of one input. In blocks with the same number of rows, rows with
        the same index come from the same parent.
        """
        units = self.units(layout)
        count = int(units.max()) + 1
        key = draws.streams[Purpose.CROSS]
        words = bits(key.take(np.s_[:, None]), draws.cell[:, None], jnp.arange(count)).hi
        from_mate = words >> np.uint32(31) == 1
        return jnp.where(from_mate[:, units], mates, parents)

    def units(self, layout: Layout) -> np.ndarray:
        """Return the number of the unit that each weight belongs to, int64 (P,)."""
        if self.unit == "block":
            return np.repeat(np.arange(len(layout.blocks)), layout.sizes)
        heights = list(dict.fromkeys(shape[0] for _, shape in layout.blocks))
        first = dict(zip(heights, np.cumsum([0, *heights]).tolist(), strict=False))
        return np.concatenate(
            [
                first[shape[0]] + np.repeat(np.arange(shape[0]), size // shape[0])
                for (_, shape), size in zip(layout.blocks, layout.sizes.tolist(), strict=True)
            ]
        )

    def mates(self, word: Wide, candidates: Array) -> Array:
        """Return the cell of each child's mate, or -1: int32 (K,).

        Args:
            word: two random words for each child, (K,).
            candidates: cells whose organisms may be the child's mate, bool (K, N).
        """
        rank = jnp.cumsum(candidates, axis=1, dtype=jnp.int32)
        chosen = (rank > below(word.hi, rank[:, -1])[:, None]).argmax(axis=1)
        there = (rank[:, -1] > 0) & chance(word.lo, jnp.float32(self.probability))
        return jnp.where(there, chosen, -1)
