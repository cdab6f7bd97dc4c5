"""Mutation: genome -> genome with a key; and founders, genomes from nothing.

Noise is read from the table of `gaussian`, by 16 random bits a weight. A child weight is one IEEE product
(quantile x scale) and one IEEE sum, so that it can be rebuilt bit for bit anywhere.
"""

from typing import Literal, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.random.keys import bits, chance
from primordia.random.wide import Wide, modulo
from primordia.rounding import rounded_product
from primordia.settings.base import Settings

BlockSetting: TypeAlias = Literal["probability", "scale", "founder_scale"]


class BlockMutation(Settings):
    """Mutation of one block of weights; what is not given is as for the whole genome."""

    probability: float | None = Field(
        None, ge=0, le=1, description="chance that a child's block mutates"
    )
    scale: float | None = Field(None, ge=0, description="standard deviation of the block's noise")
    founder_scale: float | None = Field(
        None, ge=0, description="standard deviation of a founder's weights in the block"
    )


class Mutation(Settings):
    """Gaussian noise on every weight of a block, in a share of the births.

    One uniform draw a birth decides for all blocks: block b mutates if the draw is below
    its probability. A child none of whose blocks mutates is a `copy`.
    """

    probability: float = Field(0.5, ge=0, le=1, description="chance that a child is mutated")
    scale: float = Field(0.01, ge=0, description="standard deviation of the noise on each weight")
    founder_scale: float = Field(
        0.01, ge=0, description="standard deviation of a founder's weights around zero"
    )
    blocks: dict[str, BlockMutation] = Field(
        {}, description="other values for single blocks of weights (input, recurrent, output)"
    )

    def __hash__(self) -> int:
        """Dictionaries have none, and this one is not changed."""
        return hash(self.model_dump_json())

    def own(self, field: BlockSetting, names: list[str]) -> list[float | None]:
        """What is set for each named block by itself, if anything is."""
        return [getattr(self.blocks.get(name), field, None) for name in names]

    def of_blocks(self, field: BlockSetting, names: list[str]) -> list[float]:
        """A setting's value for each named block."""
        own = self.own(field, names)
        return [getattr(self, field) if value is None else value for value in own]


def mutates(stream: Wide, cells: Array, probability: Array) -> Array:
    """Which blocks of the genomes born in these cells (K,), by their streams, take noise: bool (K, B)."""
    return chance(bits(stream, cells).hi[:, None], probability)


def noise_index(stream: Wide, cells: Array, length: int) -> Array:
    """Where in the table each weight's noise stands, for a stream and cells (K,): int32 (K, length).

    With m = ceil(length / 4), weight i takes the (i // m)-th 16 bits of draw i % m.
    """
    draws = jnp.arange(-(-length // 4), dtype=jnp.uint32)
    a, b = bits(stream.take(np.s_[:, None]), cells[:, None], draws)
    low, high = np.uint32(0xFFFF), np.uint32(16)
    quarters = jnp.concatenate([a & low, a >> high, b & low, b >> high], axis=1)
    return quarters[:, :length].astype(jnp.int32)


def newborns(
    parents: Array,
    standard: Array,
    takes: Array,
    scale: Array,
    founder: Array,
    founder_scale: Array,
) -> Array:
    """Genomes (K, P) of children of `parents` (K, P) and of founders.

    Args:
        parents: float32 (K, P).
        standard: standard Gaussian noise, float32 (K, P).
        takes: which weights take it, bool (K, P).
        scale: its standard deviation for children, float32 (K, P).
        founder: who is made from nothing, bool (K,).
        founder_scale: standard deviation of a founder's weights, float32 (P,).

    A weight is one product and one sum, each rounded.
    """
    inherited = jnp.where(takes, parents + rounded_product(standard, scale), parents)
    return jnp.where(founder[:, None], standard * founder_scale, inherited)


def ancestor_of(seed: Wide, number: Wide, count: int) -> Array:
    """Which of `count` ancestors the founder with a birth number takes, int32: worlds start apart."""
    return modulo(seed + number, count)
