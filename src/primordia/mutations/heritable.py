"""Heritable mutation: the size of mutations is inherited and mutates too."""

from typing import ClassVar, Literal

import jax.numpy as jnp
from jax import Array
from pydantic import Field

from primordia.brains.layout import Layout
from primordia.mutations.contract import Change, Family
from primordia.mutations.gaussian import Gaussian
from primordia.mutations.lengths import LONGEST, SHORTEST, length
from primordia.random.keys import Purpose, below


class Heritable(Gaussian):
    """Gaussian noise of standard deviation `scale` times 2^(q / 4). The whole number q is inherited.

    A mutant's q is the sum of its parent's q and a whole number from -stride to stride, all equally
    likely. The sum is limited to the range from `finest` to `coarsest`. Then the mutant's weights
    get noise of the new scale (Schwefel 1981; the steps are as in Dang & Lehre 2016). In the
    control `belongs = "cell"`, q belongs to a cell and not to a genome: a mutant starts from the q
    of the organism that was last born in its cell. So q is not selected with a genome.
    """

    notes: ClassVar = ("quarters",)

    stride: int = Field(
        4, ge=1, le=16, description="largest change of q in one birth, in quarters of an octave"
    )
    finest: int = Field(-48, ge=SHORTEST, le=0, description="smallest q")
    coarsest: int = Field(16, ge=0, le=LONGEST, description="largest q")
    belongs: Literal["line", "cell"] = Field(
        "line", description="line: q is inherited; cell: q stays in its cell (the control)"
    )

    @property
    def notes_from(self) -> Literal["parent", "cell"]:
        """Return the source of a child's first q; see `Mutation.notes_from`."""
        return "cell" if self.belongs == "cell" else "parent"

    def note(self, layout: Layout, family: Family, change: Change | None) -> Array:
        """Return the children's q, int32 (K, 1)."""
        step = below(family.draws.bits(Purpose.MUTATE, 1).hi, 2 * self.stride + 1) - self.stride
        step = jnp.where(self.mutating(layout, family).any(axis=1), step, 0)
        return jnp.clip(family.notes + step[:, None], self.finest, self.coarsest)

    def noise_scale(self, layout: Layout, family: Family) -> Array:
        """Return the standard deviation of the noise in each block, float32 (K, B)."""
        return super().noise_scale(layout, family) * length(family.notes)
