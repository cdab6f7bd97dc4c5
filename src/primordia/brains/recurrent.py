"""The paper's brain: one recurrent layer, which is also the memory."""

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import Biases, Hidden, layer, linear
from primordia.brains.layout import Shape


class Recurrent(Brain):
    """One hidden layer that feeds back into itself: `h' = tanh(W1 x + R h)`, `y = W2 h'`.

    Schmidgall & Hays 2021, "CartPole-survival", describe it as fully connected and recurrent with
    one hidden layer of 32 neurons. The published code has this formula, without biases. With biases
    the formula is `h' = tanh(W1 x + b + R h)`, `y = W2 h' + c`.
    """

    hidden: Hidden = 32
    biases: Biases = False

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `input` (W1), `recurrent` (R) and `output` (W2), and biases of input and output."""
        return {
            **layer("input", senses, self.hidden, self.biases),
            **layer("recurrent", self.hidden, self.hidden),
            **layer("output", self.hidden, outputs, self.biases),
        }

    def memory(self, senses: int, outputs: int) -> int:
        """Return the length of h, one number for each neuron."""
        return self.hidden

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""
        drive = linear(genome, "input", senses)
        memory = jnp.tanh(drive + linear(genome, "recurrent", memory))
        return memory, linear(genome, "output", memory)
