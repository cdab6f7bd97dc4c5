"""Brains: `(genome, memory, senses) -> (memory, output)`, for all organisms at once.

A genome is a flat float32 vector (P,) in records and files. Here it is held as named blocks of
weights, each (N, *shape): a compiled loop that cuts a flat (N, P) array into matrices copies them
at every tick (measured on a CPU: 2.5 times slower).
"""

from dataclasses import dataclass
from math import prod
from typing import Literal, Protocol, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from pydantic import Field

from primordia.settings.base import Settings

Shape: TypeAlias = tuple[int, int]
Genome: TypeAlias = dict[str, Array]


class Brain(Protocol):
    """Contract: pure, elementwise over organisms, the same bits for every N and thread count."""

    @property
    def memory(self) -> int:
        """Length of an organism's memory, which is zero at birth."""

    @property
    def blocks(self) -> dict[str, Shape]:
        """Name and shape of each block of weights; their order is the order of the flat genome."""

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """One tick: memory (N, M) and senses (N, S), float32, -> memory (N, M), output (N, A)."""


@dataclass(frozen=True)
class Linear:
    """`y = W x` for each organism, without bias.

    The longer axis of W is stored last; a batched product of small matrices is then up to four
    times faster on a CPU. All sums go through one `dot_general`, whose bits do not depend on N or
    on threads (held by a test); those of `(W * x).sum(-1)` do.
    """

    inputs: int
    outputs: int

    @property
    def shape(self) -> Shape:
        """Shape of one organism's W."""
        return (min(self.inputs, self.outputs), max(self.inputs, self.outputs))

    def __call__(self, weights: Array, x: Array) -> Array:
        """weights (N, *shape), x (N, inputs) -> (N, outputs)."""
        summed = 1 if self.inputs <= self.outputs else 2
        dimensions = (((1,), (summed,)), ((0,), (0,)))
        return lax.dot_general(x, weights, dimensions, precision=lax.Precision.HIGHEST)


@dataclass(frozen=True)
class Recurrent:
    """The paper's brain: `h' = tanh(W1 x + R h)`, `y = W2 h'`.

    Schmidgall & Hays 2021, "CartPole-survival": fully connected, recurrent, one hidden layer of
    32; the formula, without biases, is that of the published code.
    """

    input: Linear
    recurrent: Linear
    output: Linear

    @property
    def memory(self) -> int:
        """One number a neuron."""
        return self.recurrent.outputs

    @property
    def blocks(self) -> dict[str, Shape]:
        """Three."""
        layers = {"input": self.input, "recurrent": self.recurrent, "output": self.output}
        return {name: layer.shape for name, layer in layers.items()}

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """One tick; see `Brain`."""
        drive = self.input(genome["input"], senses)
        memory = jnp.tanh(drive + self.recurrent(genome["recurrent"], memory))
        return memory, self.output(genome["output"], memory)


@dataclass(frozen=True)
class FeedForward:
    """One hidden layer and no memory: `y = W2 tanh(W1 x)`."""

    input: Linear
    output: Linear

    @property
    def memory(self) -> int:
        """None."""
        return 0

    @property
    def blocks(self) -> dict[str, Shape]:
        """Two."""
        return {"input": self.input.shape, "output": self.output.shape}

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        """One tick; see `Brain`."""
        hidden = jnp.tanh(self.input(genome["input"], senses))
        return memory, self.output(genome["output"], hidden)


class BrainSettings(Settings):
    """Which brain the organisms have."""

    kind: Literal["recurrent", "feed-forward"] = Field(
        "recurrent", description="recurrent: the paper's, with memory; feed-forward: without"
    )
    hidden: int = Field(32, ge=1, le=4096, description="neurons in the hidden layer")

    def build(self, senses: int, outputs: int) -> Brain:
        """The brain for a habitat with so many senses and a motor with so many outputs."""
        into, out = Linear(senses, self.hidden), Linear(self.hidden, outputs)
        if self.kind == "feed-forward":
            return FeedForward(into, out)
        return Recurrent(into, Linear(self.hidden, self.hidden), out)


def genome_length(brain: Brain) -> int:
    """P, the number of weights of one organism."""
    return sum(prod(shape) for shape in brain.blocks.values())


def split(brain: Brain, flat: Array) -> Genome:
    """Cut flat genomes (..., P) into the brain's blocks (..., *shape)."""
    sizes = [prod(shape) for shape in brain.blocks.values()]
    parts = jnp.split(flat, np.cumsum(sizes)[:-1], axis=-1)
    shapes = brain.blocks.items()
    return {
        name: part.reshape(*flat.shape[:-1], *shape)
        for (name, shape), part in zip(shapes, parts, strict=True)
    }


def join(brain: Brain, genome: dict[str, np.ndarray]) -> np.ndarray:
    """Flat genomes (N, P) of blocks (N, *shape), on the host."""
    return np.concatenate([genome[name].reshape(len(genome[name]), -1) for name in brain.blocks], 1)
