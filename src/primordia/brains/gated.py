"""A brain that can keep a memory for long: a gated recurrent unit."""

import jax.numpy as jnp
from jax import Array

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import Biases, Hidden, gate, layer, linear, mix
from primordia.brains.layout import Shape

PARTS = ("reset", "update", "candidate")


class Gated(Brain):
    """A gated recurrent unit (GRU), and a linear output.

        r  = s(Wr x + Ur h)         reset gate, s the logistic function
        z  = s(Wz x + Uz h)         update gate
        c  = tanh(W x + U (r * h))  candidate
        h' = z * h + (1 - z) * c
        y  = V h'

    Cho et al. 2014, "Learning phrase representations using RNN encoder-decoder", sec. 2.3, there
    without biases. With biases each of r, z, c and y has one.
    """

    hidden: Hidden = 32
    biases: Biases = False

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `reset_input` (Wr) and `reset_recurrent` (Ur), so for update and candidate; `output`."""
        blocks: dict[str, Shape] = {}
        for part in PARTS:
            blocks |= layer(f"{part}_input", senses, self.hidden, self.biases)
            blocks |= layer(f"{part}_recurrent", self.hidden, self.hidden)
        return blocks | layer("output", self.hidden, outputs, self.biases)

    def memory(self, senses: int, outputs: int) -> int:
        """Return one number a neuron: h."""
        return self.hidden

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""

        def drive(part: str, before: Array) -> Array:
            perceived = linear(genome, f"{part}_input", senses)
            return perceived + linear(genome, f"{part}_recurrent", before)

        reset, update = gate(drive("reset", memory)), gate(drive("update", memory))
        candidate = jnp.tanh(drive("candidate", reset * memory))
        memory = mix(update, memory, candidate)
        return memory, linear(genome, "output", memory)
