"""Functions of JAX whose sums over axes do not depend on the number of bodies.

A compiler sums in an order of its own, which depends on shapes. Here sums over axes, also those of
matrix products, are trees of additions in a fixed order.
"""

from collections.abc import Callable
from math import prod
from typing import Any

import jax.numpy as jnp
from jax import Array
from jax.extend.core import JaxprEqn

from primordia.jaxprs import rewritten


def ordered(function: Callable) -> Callable:
    """Return the function with each sum of float32 over axes in an order fixed by the axes' lengths."""
    return rewritten(function, {"reduce_sum": _reduce_sum, "dot_general": _dot_general})


def _reduce_sum(equation: JaxprEqn, inputs: list[Any], _: list[bool]) -> Array:
    (a,), axes = inputs, equation.params["axes"]
    return _summed(jnp.moveaxis(a, axes, range(len(axes))), len(axes))


def _dot_general(equation: JaxprEqn, inputs: list[Any], _: list[bool]) -> Array:
    summed, batch = equation.params["dimension_numbers"]
    shared = len(summed[0]) + len(batch[0])
    a, b = (
        jnp.moveaxis(each.astype(jnp.float32), (*over, *beside), range(shared))
        for each, over, beside in zip(inputs, summed, batch, strict=True)
    )
    a, b = (
        a.reshape(*a.shape, *[1] * (b.ndim - shared)),
        b.reshape(*b.shape[:shared], *[1] * (a.ndim - shared), *b.shape[shared:]),
    )
    return _summed(a * b, len(summed[0]))


def _summed(a: Array, axes: int) -> Array:
    """Return the sum over the first axes, in the same order for arrays of all shapes."""
    a = a.reshape(prod(a.shape[:axes]), *a.shape[axes:])  # also for an empty axis
    while (count := len(a)) > 1:
        half = (count + 1) // 2
        a = jnp.concatenate([a[: count // 2] + a[half:], a[count // 2 : half]])
    return a.sum(axis=0)
