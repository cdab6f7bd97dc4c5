"""Layers of brains: products with matrices, gates, and the settings that brains share."""

from collections.abc import Mapping
from typing import Annotated, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from pydantic import Field

from primordia.brains.layout import Shape

Hidden: TypeAlias = Annotated[int, Field(ge=1, le=4096, description="neurons in the hidden layer")]
Biases: TypeAlias = Annotated[
    bool, Field(description="true: layers add biases, each a block of weights")
]


def layer(name: str, inputs: int, outputs: int, bias: bool = False) -> dict[str, Shape]:
    """Return the blocks of a layer `W x` or `W x + b`: W is `NAME`, and b is `NAME_bias`.

    The longer axis of W comes last, since a batched product of small matrices is then up to four
    times faster on a CPU.
    """
    weights = {name: (min(inputs, outputs), max(inputs, outputs))}
    return {**weights, f"{name}_bias": (outputs,)} if bias else {**weights}


def linear(genome: Mapping[str, Array], name: str, x: Array) -> Array:
    """Return a layer's output (N, outputs) for x (N, inputs), plus the bias if the genome has one."""
    product, bias = matvec(genome[name], x), genome.get(f"{name}_bias")
    return product if bias is None else product + bias


def matvec(weights: Array, x: Array) -> Array:
    """Return W x for each organism; weights are (N, *shape) as in `layer`, and x is (N, inputs).

    One `dot_general` computes all sums. Its bits do not depend on N or on the number of threads (a test
    checks this). The bits of `(W * x).sum(-1)` depend on both.
    """
    summed = 1 if weights.shape[1] == x.shape[1] else 2
    dimensions = (((1,), (summed,)), ((0,), (0,)))
    return lax.dot_general(x, weights, dimensions, precision=lax.Precision.HIGHEST)


def gate(x: Array) -> Array:
    """Return the logistic function of x, from 0 to 1.

    The function is computed from tanh. Products with 1/2 are exact, so a compiler that rounds
    a product and a sum together changes no bit.
    """
    half = np.float32(0.5)
    return half + half * jnp.tanh(half * x)


def mix(share: Array, a: Array, b: Array) -> Array:
    """Return `share a + (1 - share) b`, share from 0 to 1."""
    return share * a + (1 - share) * b
