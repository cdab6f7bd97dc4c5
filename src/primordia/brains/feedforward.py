"""A brain with a hidden layer and without memory."""

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import Biases, Hidden, layer, linear
from primordia.brains.layout import Shape


class FeedForward(Brain):
    """One hidden layer and no memory: `y = W2 tanh(W1 x)`, with biases `y = W2 tanh(W1 x + b) + c`."""

    hidden: Hidden = 32
    biases: Biases = False

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `input` (W1) and `output` (W2), and their biases."""
        return {
            **layer("input", senses, self.hidden, self.biases),
            **layer("output", self.hidden, outputs, self.biases),
        }

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""
        hidden = jnp.tanh(linear(genome, "input", senses))
        return memory, linear(genome, "output", hidden)
