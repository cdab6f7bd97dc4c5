"""Arithmetic that every compiler rounds in the same way.

Compilers change arithmetic. They contract a product and a sum into a fused multiply-add, which rounds
once, and they regroup constants: `x * a * b` becomes `x * (a * b)`. Whether they do so depends on their
version, on the processor, on the number of organisms, and on everything else that a program
computes. With JAX 0.12, CartPole's body had other bits among 31 organisms than among 1,024, and others
again alone. So each result of float32 arithmetic passes through an integer operation: an exclusive or
with 0, which changes nothing. The 0 is an argument of the compiled program, so the compiler does not
know it, and has to compute each result as it is written.
"""

from collections.abc import Callable
from typing import Any

import jax.numpy as jnp
from jax import Array, lax
from jax.extend.core import JaxprEqn

from primordia.jaxprs import bind, rewritten

ARITHMETIC = ("add", "sub", "mul", "square", "integer_pow", "dot_general")
"""Primitives whose results compilers may round in another way."""


def rounded(function: Callable) -> Callable:
    """Return `(zero, *arguments) -> function(*arguments)`, with each result of arithmetic rounded.

    `zero` is uint32 (). It must be 0, and the compiler must not know it.
    """

    def compute(zero: Array, *arguments: Any) -> Any:
        def round_result(equation: JaxprEqn, inputs: list[Any]) -> Array:
            return _float(_bits(bind(equation, inputs)) ^ zero)

        def divide(_: JaxprEqn, inputs: list[Any]) -> Array:
            # A divisor that all numbers share would be replaced by its reciprocal, in vectors only.
            a, b = inputs
            return _float(_bits(lax.div(a, _float(_bits(b) ^ (_bits(a) & zero)))) ^ zero)

        rules = {**dict.fromkeys(ARITHMETIC, round_result), "div": divide}
        return rewritten(function, rules)(*arguments)

    return compute


def _bits(number: Any) -> Array:
    return lax.bitcast_convert_type(number, jnp.uint32)


def _float(bits: Array) -> Array:
    return lax.bitcast_convert_type(bits, jnp.float32)
