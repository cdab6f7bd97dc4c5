"""A mutation of your own: each organism inherits the size of the mutations that its children get.

    primordia run CartPole-survival --mutation.kind examples.mutation:SelfAdaptive

Run it where the folder `examples` is. The births table then has a column `octaves8`: the exponent of
each organism, in eighths of an octave.
"""

from collections.abc import Mapping
from typing import ClassVar

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.brains.layout import Layout
from primordia.mutations.contract import Change, Draws, Family, Mutation
from primordia.mutations.noise import standard_noise
from primordia.random.keys import Purpose, below, chance
from primordia.settings.base import Rate

FLOOR, CEILING = -64, 32
"""Exponents go from 2^-8 to 2^4."""
EIGHTHS = (1.0, 1.0905077, 1.1892071, 1.2968396, 1.4142135, 1.5422108, 1.6817929, 1.8340081)
"""2^(0/8) to 2^(7/8). No library's power function takes part, so all machines have the same table."""
FACTORS = np.array(
    [np.ldexp(np.float32(EIGHTHS[n % 8]), n // 8) for n in range(FLOOR, CEILING + 1)], np.float32
)


class SelfAdaptive(Mutation):
    """Gaussian noise on all weights, of a scale that is inherited and mutates itself.

    A mutant's exponent goes up or down by up to `stride` eighths of an octave; then its weights get noise
    of the scale `scale * 2^(exponent / 8)` (Schwefel 1981, in steps of an integer, so that no rounding
    adds up). The exponent is kept as a note, so genomes are rebuilt from records.
    """

    notes: ClassVar = ("octaves8",)

    probability: Rate = Field(0.5, ge=0, le=1, description="chance that a child is mutated")
    scale: Rate = Field(0.01, ge=0, description="standard deviation of the noise at exponent 0")
    stride: int = Field(2, ge=0, le=16, description="most eighths of an octave in one birth")
    founder_scale: float = Field(
        0.01, ge=0, description="standard deviation of a founder's weights around zero"
    )

    def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
        """Return the children's exponents, int32 (K, 1)."""
        _, notes, rates, draws = family
        step = below(draws.bits(Purpose.MUTATE, 1).hi, 2 * self.stride + 1) - self.stride
        step = jnp.where(_mutates(rates, draws), step, 0)
        return jnp.clip(notes + step[:, None], FLOOR, CEILING)

    def inherit(self, layout: Layout, family: Family) -> tuple[Array, Array]:
        """Add noise of the children's own scale to the mutants' weights."""
        parents, notes, rates, draws = family
        mutates = _mutates(rates, draws)
        scale = rates["scale"] * jnp.asarray(FACTORS)[notes[:, 0] - FLOOR]
        noise = standard_noise(draws.streams[Purpose.NOISE], draws.cell, layout.length)
        mutants = parents + noise * scale[:, None]
        return jnp.where(mutates[:, None], mutants, parents), mutates

    def founders(self, layout: Layout, draws: Draws) -> Array:
        """Make founders' genomes: Gaussian weights around zero."""
        noise = standard_noise(draws.streams[Purpose.FOUNDER], draws.cell, layout.length)
        return noise * np.float32(self.founder_scale)


def _mutates(rates: Mapping[str, Array], draws: Draws) -> Array:
    return chance(draws.bits(Purpose.MUTATE).hi, rates["probability"])
