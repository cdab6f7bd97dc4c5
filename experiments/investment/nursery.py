"""A habitat for the theory of parental investment: what a child is given decides whether it grows up.

A child finds no food until its childhood ends. It lives on what its parent gave it, one unit of energy
in a tick, so it grows up if its endowment is larger than its childhood is long. Childhoods are drawn
from a known distribution. So the share of children that grow up is a known function f of the endowment.
Most of those that grow up die at once, whatever they were given: then what is left of an endowment is a
small part of the energy of an adult life.
"""

from typing import Any, Literal

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.habitats import Discrete, JaxHabitat, Outcome
from primordia.settings.base import Settings


class Nursery(JaxHabitat, Settings):
    """Bodies that wait for the end of their childhood, and then eat."""

    survival: Literal["weibull", "hill"] = Field(
        description="distribution of childhoods. weibull: f(e) = 1 - exp(-(e / scale)^shape); hill:"
        " f(e) = e^shape / (e^shape + scale^shape)"
    )
    scale: float = Field(gt=0, description="scale of the distribution, ticks")
    shape: float = Field(gt=1, description="shape of the distribution")
    settling: float = Field(0.2, gt=0, le=1, description="share of the grown-up that do not die")
    food: float = Field(2.0, gt=0, description="food of an adult in a tick")

    senses_size: int = 1
    action: Any = Discrete(2)
    words: int = 2

    def reset(self, words: Array) -> Array:
        """Return bodies float32 (N, 2): ticks to the end of childhood, and 1 if the body then dies."""
        share = (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)
        u = jnp.clip(share[:, 0], 2**-24, 1 - 2**-24)
        odds = -jnp.log1p(-u) if self.survival == "weibull" else u / (1 - u)
        childhood = np.float32(self.scale) * odds ** np.float32(1 / self.shape)
        dies = (share[:, 1] >= np.float32(self.settling)).astype(jnp.float32)
        return jnp.stack([childhood, dies], axis=1)

    def sense(self, bodies: Array) -> Array:
        """Return a constant, float32 (N, 1): a body perceives nothing."""
        return jnp.ones((len(bodies), 1), jnp.float32)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        """Wait, or eat.

        In the tick in which childhood ends, the body eats for the rest of the tick one unit in a tick, so
        that childhoods need not be whole numbers.
        """
        before, dies = bodies.T
        left = jnp.maximum(before - 1, -1)
        food = jnp.where(before <= 0, np.float32(self.food), jnp.maximum(-left, 0))
        fatal = (before > 0) & (left <= 0) & (dies > 0)
        return jnp.stack([left, dies], axis=1), Outcome(fatal, food)
