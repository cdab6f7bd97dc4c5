"""A brain with a long memory: a gated recurrent unit."""

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import Biases, Hidden, gate, layer, linear, mix
from primordia.brains.layout import Shape

UNITS = ("reset", "update", "candidate")
"""parts of a gated recurrent unit, each with weights for senses and for memory"""


class Gated(Brain):
    """A gated recurrent unit (GRU), and a linear output.

        r  = s(Wr x + Ur h)         reset gate, s the logistic function
        z  = s(Wz x + Uz h)         update gate
        c  = tanh(W x + U (r * h))  candidate
        h' = z * h + (1 - z) * c
        y  = V h'

    Cho et al. 2014, "Learning phrase representations using RNN encoder-decoder", sec. 2.3. The paper
    has no biases. With `biases`, one bias is added in each of r, z, c and y.
    """

    hidden: Hidden = 32
    biases: Biases = False

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `UNIT_input` and `UNIT_recurrent` for each of UNITS (Wr, Ur, ...), and `output` (V)."""
        blocks: dict[str, Shape] = {}
        for unit in UNITS:
            blocks |= layer(f"{unit}_input", senses, self.hidden, self.biases)
            blocks |= layer(f"{unit}_recurrent", self.hidden, self.hidden)
        return blocks | layer("output", self.hidden, outputs, self.biases)

    def memory(self, senses: int, outputs: int) -> int:
        """Return the length of h, one number for each neuron."""
        return self.hidden

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""

        def drive(unit: str, before: Array) -> Array:
            perceived = linear(genome, f"{unit}_input", senses)
            return perceived + linear(genome, f"{unit}_recurrent", before)

        reset, update = gate(drive("reset", memory)), gate(drive("update", memory))
        candidate = jnp.tanh(drive("candidate", reset * memory))
        memory = mix(update, memory, candidate)
        return memory, linear(genome, "output", memory)
