"""Arithmetic that every compiler rounds in the same way.

A compiler may contract a product and a sum into a fused multiply-add, which rounds once. Whether it
does so depends on its version, on the processor, on the number of organisms, and on everything else
that a program computes. With JAX 0.12, CartPole's body had other bits among 31 organisms than
among 1,024. So each float32 product to which something may be added passes through an integer operation
first: an exclusive or with 0, which changes nothing. The 0 is an argument of the compiled program, so
the compiler does not know it.
"""

from collections.abc import Callable
from typing import Any

import jax.numpy as jnp
from jax import Array, lax
from jax.extend.core import Jaxpr, JaxprEqn, Literal

from primordia.jaxprs import bind, rewritten

PRODUCTS = ("mul", "square", "integer_pow", "dot_general")
"""Primitives that multiply. A `dot_general` that sums over an axis of length 1 is a product."""

NO_SUM = {
    "mul",
    "square",
    "integer_pow",
    "div",
    "lt",
    "le",
    "gt",
    "ge",
    "eq",
    "ne",
    "floor",
    "ceil",
}
"""Primitives that compute no sum of their arguments, so a product before them is not contracted.
Others, such as the sine, may be computed by compilers as sums."""


def rounded(function: Callable) -> Callable:
    """Return `(zero, *arguments) -> function(*arguments)`, with each product rounded before a sum.

    `zero` is uint32 (). It must be 0, and the compiler must not know it.
    """

    def compute(zero: Array, *arguments: Any) -> Any:
        def round_product(equation: JaxprEqn, inputs: list[Any]) -> Array:
            bits = lax.bitcast_convert_type(bind(equation, inputs), jnp.uint32)
            return lax.bitcast_convert_type(bits ^ zero, jnp.float32)

        return rewritten(function, dict.fromkeys(PRODUCTS, round_product), _never_added)(*arguments)

    return compute


def _never_added(function: Jaxpr) -> set:
    """Return the variables to which nothing is added: all of their users are in NO_SUM."""
    adding = [each for each in function.eqns if each.primitive.name not in NO_SUM]
    added = [*function.outvars, *(variable for each in adding for variable in each.invars)]
    used = {each for each in added if not isinstance(each, Literal)}
    return {each for equation in function.eqns for each in equation.outvars} - used
