"""Calibrated mutation: noise with a given effect on the child's behaviour, in every game."""

from typing import ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from pydantic import Field

from primordia.brains.layout import Layout
from primordia.mutations.blocks import FounderBlock, check_blocks, per_block
from primordia.mutations.contract import Change, Draws, Family, Moments, Mutation
from primordia.mutations.lengths import SHORTEST, length
from primordia.mutations.noise import standard_noise
from primordia.random.keys import Purpose, chance
from primordia.settings.base import Rate

STEPS = 7
"""Steps of the bisection among the 96 values of q from SHORTEST + 1 to 0."""


class Calibrated(Mutation):
    """Gaussian noise whose size is chosen for each child by its effect on behaviour.

    The direction is random: noise with the standard deviation of founders' weights in each block.
    This noise is multiplied by 2^(q / 4). Bisection finds a q from -96 to 0. With this q, child and
    parent act differently in some of the parent's moments; their share is at most `differs`. With q
    + 1, unless q is 0, they act differently in a larger share. For continuous actions, `differs`
    limits the root mean square change of the outputs. This is SM-R of Lehman et al. 2018,
    arXiv:1712.06563, but lengths are whole steps, so that genomes can be rebuilt. The note
    `quarters` is q, and 0 for a copy.
    """

    notes: ClassVar = ("quarters",)

    probability: Rate = Field(0.5, ge=0, le=1, description="chance that a child is mutated")
    differs: Rate = Field(
        0.02,
        ge=0,
        description="largest change of behaviour: share of changed choices, or change of outputs",
    )
    remembered: int = Field(
        64, ge=1, le=256, description="number of moments that organisms remember"
    )
    every: int = Field(16, ge=1, le=256, description="ticks from one remembered moment to the next")
    founder_scale: float = Field(
        0.01, ge=0, description="standard deviation of a founder's weights around zero"
    )
    blocks: dict[str, FounderBlock] = Field(
        {}, description="values for single blocks of weights, such as input, recurrent, output"
    )

    def __hash__(self) -> int:
        """Return a hash of the values. The dictionary `blocks` has no hash of its own, but never
        changes."""
        return hash(self.model_dump_json())

    @property
    def moments(self) -> Moments:
        """Return which moments organisms remember; see `Mutation.moments`."""
        return Moments(self.remembered, self.every)

    def check(self, layout: Layout) -> None:
        """Raise ValueError if `blocks` names a block that genomes of this layout do not have."""
        check_blocks(self.blocks, layout)

    def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
        """Return the children's q, int32 (K, 1)."""
        if change is None:
            raise ValueError("a calibrated mutation needs the parents' moments")

        mutates = self._mutates(family)

        def search() -> Array:
            low = jnp.full(len(family.parents), SHORTEST, jnp.int32)
            return lax.fori_loop(0, STEPS, halve, (low, jnp.ones_like(low)))[0]

        def halve(_: int, bounds: tuple[Array, Array]) -> tuple[Array, Array]:
            low, high = bounds
            middle = (low + high) // 2
            near = change(self._mutants(layout, family, middle)) <= family.rates["differs"]
            return jnp.where(near, middle, low), jnp.where(near, high, middle)

        none = jnp.zeros(len(family.parents), jnp.int32)
        found = lax.cond(mutates.any(), search, lambda: none)
        return jnp.where(mutates, found, none)[:, None]

    def inherit(self, layout: Layout, family: Family) -> tuple[Array, Array]:
        """Add noise, multiplied by 2^(q / 4) with the child's q; see `Mutation.inherit`."""
        mutates = self._mutates(family)
        mutants = self._mutants(layout, family, family.notes[:, 0])
        return jnp.where(mutates[:, None], mutants, family.parents), mutates

    def founders(self, layout: Layout, draws: Draws) -> Array:
        """Make the genomes of founders: Gaussian weights around zero."""
        noise = standard_noise(draws.streams[Purpose.FOUNDER], draws.cell, layout.length)
        return noise * self._scales(layout)

    def _mutates(self, family: Family) -> Array:
        return chance(family.draws.bits(Purpose.MUTATE).hi, family.rates["probability"])

    def _mutants(self, layout: Layout, family: Family, quarters: Array) -> Array:
        parents, _, _, draws = family
        noise = standard_noise(draws.streams[Purpose.NOISE], draws.cell, layout.length)
        scale = self._scales(layout) * length(quarters)[:, None]
        return parents + noise * scale

    def _scales(self, layout: Layout) -> Array:
        """Return the standard deviation of each of a founder's weights, float32 (P,)."""
        scales = np.array(per_block(self, self.blocks, "founder_scale", layout), np.float32)
        return jnp.asarray(np.repeat(scales, layout.sizes))
