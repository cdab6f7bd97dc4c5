"""Gaussian mutation: noise on every weight of a block, in a share of the births."""

from collections.abc import Mapping
from typing import Literal, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.brains.layout import Layout
from primordia.mutations.contract import Draws, Mutation
from primordia.mutations.noise import standard_noise
from primordia.random.keys import Purpose, chance
from primordia.rounding import rounded_product
from primordia.settings.base import Rate, Settings

BlockField: TypeAlias = Literal["probability", "scale", "founder_scale"]
SEASONAL_FIELDS: tuple[BlockField, ...] = ("probability", "scale")


class Block(Settings):
    """Mutation of one block of weights; a setting of None has the whole genome's value."""

    probability: float | None = Field(
        None, ge=0, le=1, description="chance that a child's block mutates"
    )
    scale: float | None = Field(None, ge=0, description="standard deviation of the block's noise")
    founder_scale: float | None = Field(
        None, ge=0, description="standard deviation of a founder's weights in the block"
    )


class Gaussian(Mutation):
    """Gaussian noise of a fixed scale (Schmidgall & Hays 2021, "Mutation").

    One uniform draw a birth decides for all blocks: block b mutates if the draw is below
    its probability. A child none of whose blocks mutates is a copy.
    """

    probability: Rate = Field(0.5, ge=0, le=1, description="chance that a child is mutated")
    scale: Rate = Field(0.01, ge=0, description="standard deviation of the noise on each weight")
    founder_scale: float = Field(
        0.01, ge=0, description="standard deviation of a founder's weights around zero"
    )
    blocks: dict[str, Block] = Field(
        {}, description="values for single blocks of weights, such as input, recurrent, output"
    )

    def __hash__(self) -> int:
        """Return a hash of the values; `blocks` is a dictionary, which has none, and never changes."""
        return hash(self.model_dump_json())

    def check(self, layout: Layout) -> None:
        """Raise ValueError if `blocks` names a block that genomes of this layout do not have."""
        for name in self.blocks:
            if name not in layout.names:
                known = ", ".join(layout.names)
                raise ValueError(f"blocks: this brain has no block {name!r}; it has {known}")

    def rates(self, layout: Layout) -> dict[str, float]:
        """Return probability and scale of each block, such as `blocks.input.scale`."""
        return {
            _rate(block, field): value
            for field in SEASONAL_FIELDS
            for block, value in zip(layout.names, self.per_block(field, layout), strict=True)
        }

    def governed(self, setting: str, layout: Layout) -> list[str]:
        """Return the rates that a season of `scale`, or of `blocks.input.scale`, changes."""
        for field in SEASONAL_FIELDS:
            if setting == field:
                return [
                    _rate(block, field)
                    for block in layout.names
                    if getattr(self.blocks.get(block), field, None) is None
                ]
        return super().governed(setting, layout)

    def inherit(
        self,
        layout: Layout,
        parents: Array,
        notes: Array,
        rates: Mapping[str, Array],
        draws: Draws,
    ) -> tuple[Array, Array]:
        """Add noise to the blocks that mutate; see `Mutation.inherit`."""
        probability, scale = (
            jnp.stack([rates[_rate(block, field)] for block in layout.names], axis=1)
            for field in SEASONAL_FIELDS
        )
        mutates = chance(draws.bits(Purpose.MUTATE).hi[:, None], probability)
        noise = standard_noise(draws.streams[Purpose.NOISE], draws.cell, layout.length)
        noise = rounded_product(noise, layout.per_weight(scale))
        children = jnp.where(layout.per_weight(mutates), parents + noise, parents)
        return children, mutates.any(axis=1)

    def founders(self, layout: Layout, draws: Draws) -> Array:
        """Make the genomes of founders: Gaussian weights around zero."""
        noise = standard_noise(draws.streams[Purpose.FOUNDER], draws.cell, layout.length)
        scales = np.array(self.per_block("founder_scale", layout), np.float32)
        return noise * jnp.asarray(np.repeat(scales, layout.sizes))

    def per_block(self, field: BlockField, layout: Layout) -> list[float]:
        """Return a setting's value for each block: the block's, or else the whole genome's."""
        own = [getattr(self.blocks.get(block), field, None) for block in layout.names]
        return [getattr(self, field) if value is None else value for value in own]


def _rate(block: str, field: BlockField) -> str:
    return f"blocks.{block}.{field}"
