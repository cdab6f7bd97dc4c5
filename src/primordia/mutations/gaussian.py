"""Gaussian mutation: noise on every weight of a block, in a share of the births."""

from typing import Literal, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.brains.layout import Layout
from primordia.mutations.blocks import FounderBlock, check_blocks, per_block
from primordia.mutations.contract import Draws, Family, Mutation
from primordia.mutations.noise import standard_noise
from primordia.random.keys import Purpose, chance
from primordia.settings.base import Rate

BlockField: TypeAlias = Literal["probability", "scale", "founder_scale"]
SEASONAL_FIELDS: tuple[BlockField, ...] = ("probability", "scale")


class Block(FounderBlock):
    """Mutation of one block of weights. None stands for the whole genome's value."""

    probability: float | None = Field(
        None, ge=0, le=1, description="chance that a child's block mutates"
    )
    scale: float | None = Field(None, ge=0, description="standard deviation of the block's noise")


class Gaussian(Mutation):
    """Gaussian noise of a fixed scale (Schmidgall & Hays 2021, "Mutation").

    In each birth one uniform draw decides for all blocks: block b mutates if the draw is below
    its probability. A child is a copy if none of its blocks mutates.
    """

    probability: Rate = Field(0.5, ge=0, le=1, description="chance that a child is mutated")
    scale: Rate = Field(0.01, ge=0, description="standard deviation of the noise on each weight")
    density: float = Field(
        1.0, ge=2**-15, le=1, description="share of the weights that a mutation changes"
    )
    founder_scale: float = Field(
        0.01, ge=0, description="standard deviation of a founder's weights around zero"
    )
    blocks: dict[str, Block] = Field(
        {}, description="values for single blocks of weights, such as input, recurrent, output"
    )

    def __hash__(self) -> int:
        """Return a hash of the values. The dictionary `blocks` has no hash of its own, but never
        changes."""
        return hash(self.model_dump_json())

    def check(self, layout: Layout) -> None:
        """Raise ValueError if `blocks` names a block that genomes of this layout do not have."""
        check_blocks(self.blocks, layout)

    def rates(self, layout: Layout) -> dict[str, float]:
        """Return probability and scale of each block, such as `blocks.input.scale`."""
        return {
            _rate(block, field): value
            for field in SEASONAL_FIELDS
            for block, value in zip(layout.names, self.per_block(field, layout), strict=True)
        }

    def governed(self, setting: str, layout: Layout) -> list[str]:
        """Return the rates that change if a season changes `scale` or `blocks.input.scale`."""
        for field in SEASONAL_FIELDS:
            if setting == field:
                return [
                    _rate(block, field)
                    for block in layout.names
                    if getattr(self.blocks.get(block), field, None) is None
                ]
        return super().governed(setting, layout)

    def inherit(self, layout: Layout, family: Family) -> tuple[Array, Array]:
        """Add noise to the blocks that mutate; see `Mutation.inherit`."""
        parents, draws, mutates = family.parents, family.draws, self.mutating(layout, family)
        stream, length = draws.streams[Purpose.NOISE], layout.length
        noise = standard_noise(stream, draws.cell, length, self.density)
        noise = noise * layout.per_weight(self.noise_scale(layout, family))
        children = jnp.where(layout.per_weight(mutates), parents + noise, parents)
        return children, mutates.any(axis=1)

    def mutating(self, layout: Layout, family: Family) -> Array:
        """Return which blocks mutate, bool (K, B)."""
        probability = _of_blocks("probability", layout, family)
        return chance(family.draws.bits(Purpose.MUTATE).hi[:, None], probability)

    def noise_scale(self, layout: Layout, family: Family) -> Array:
        """Return the standard deviation of the noise in each block, float32 (K, B)."""
        return _of_blocks("scale", layout, family)

    def founders(self, layout: Layout, draws: Draws) -> Array:
        """Make the genomes of founders: Gaussian weights around zero."""
        noise = standard_noise(draws.streams[Purpose.FOUNDER], draws.cell, layout.length)
        scales = np.array(self.per_block("founder_scale", layout), np.float32)
        return noise * jnp.asarray(np.repeat(scales, layout.sizes))

    def per_block(self, field: BlockField, layout: Layout) -> list[float]:
        """Return a setting's value for each block: the block's own value, or the whole genome's value."""
        return per_block(self, self.blocks, field, layout)


def _of_blocks(field: BlockField, layout: Layout, family: Family) -> Array:
    """Return the present values of a rate, float32 (K, B)."""
    return jnp.stack([family.rates[_rate(block, field)] for block in layout.names], axis=1)


def _rate(block: str, field: BlockField) -> str:
    return f"blocks.{block}.{field}"
