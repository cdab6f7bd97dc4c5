"""A brain of your own: leaky neurons, each with a time constant that evolves.

    primordia run CartPole-survival --brain.kind examples.brain:Leaky --brain.neurons 16

Run it where the folder `examples` is. `--help` after these words lists the brain's settings.
"""

import jax.numpy as jnp
from jax import Array
from pydantic import Field

from primordia.brains.contract import Brain, Genome
from primordia.brains.layers import gate, layer, linear, mix
from primordia.brains.layout import Shape


class Leaky(Brain):
    """A continuous-time recurrent network (Beer 1995), stepped once a tick:

        h' = k * h + (1 - k) * tanh(W x + U h),   y = V h'

    The share k that a neuron keeps is its own: the logistic function of its weight in block `keep`.
    """

    neurons: int = Field(16, ge=1, le=4096, description="neurons in the hidden layer")

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        """Return `input` (W), `recurrent` (U), `keep` and `output` (V)."""
        return {
            **layer("input", senses, self.neurons),
            **layer("recurrent", self.neurons, self.neurons),
            "keep": (self.neurons,),
            **layer("output", self.neurons, outputs),
        }

    def memory(self, senses: int, outputs: int) -> int:
        """Return one number a neuron: h."""
        return self.neurons

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """Think for one tick; see `Brain`."""
        drive = linear(genome, "input", senses) + linear(genome, "recurrent", memory)
        memory = mix(gate(genome["keep"]), memory, jnp.tanh(drive))
        return memory, linear(genome, "output", memory)
