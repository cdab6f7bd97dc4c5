"""Arithmetic that every compiler rounds in the same way.

Compilers change arithmetic. They contract a product and a sum into a fused multiply-add, which rounds
once. They regroup constants: `x * a * b` becomes `x * (a * b)`. They replace divisions by a number that
all organisms share. Whether they do so depends on their version, on the processor, on the number of
organisms, and on everything else that a program computes. With JAX 0.12, CartPole's body had other
bits among 31 organisms than among 1,024, and others again alone. So the float32 numbers of a program
pass through an integer operation wherever a compiler could do this: an exclusive or with 0, which
changes nothing. The 0 is an argument of the compiled program, so the compiler does not know it, and
has to compute each result as it is written.
"""

from collections.abc import Callable
from typing import Any

import jax.numpy as jnp
from jax import Array, lax
from jax.extend.core import JaxprEqn

from primordia.jaxprs import bind, rewritten

PRODUCTS = ("mul", "square", "integer_pow", "dot_general")
"""Primitives that multiply. A `dot_general` that sums over an axis of length 1 is a product."""


def rounded(function: Callable) -> Callable:
    """Return `(zero, *arguments) -> function(*arguments)`, computed as it is written.

    `zero` is uint32 (). It must be 0, and the compiler must not know it.
    """

    def compute(zero: Array, *arguments: Any) -> Any:
        def multiply(equation: JaxprEqn, inputs: list[Any], _: list[bool]) -> Array:
            return _float(_bits(bind(equation, inputs)) ^ zero)

        def add(equation: JaxprEqn, inputs: list[Any], constant: list[bool]) -> Array:
            total = bind(equation, inputs)
            return _float(_bits(total) ^ zero) if any(constant) else total

        def divide(_: JaxprEqn, inputs: list[Any], __: list[bool]) -> Array:
            # A divisor that all numbers share would be replaced by its reciprocal, in vectors only; and
            # a quotient that is divided again, by a product of divisors.
            a, b = map(_bits, inputs)
            return _float(a ^ zero) / _float(b ^ (a & zero))

        def atan(_: JaxprEqn, inputs: list[Any], __: list[bool]) -> Array:
            # XLA's atan, and not its atan2, has other bits for other numbers of organisms.
            (a,) = inputs
            return lax.atan2(a, _float(_bits(jnp.ones_like(a)) ^ zero))

        products = dict.fromkeys(PRODUCTS, multiply)
        rules = {**products, "add": add, "sub": add, "div": divide, "atan": atan}
        return rewritten(function, rules)(*arguments)

    return compute


def _bits(number: Any) -> Array:
    return lax.bitcast_convert_type(number, jnp.uint32)


def _float(bits: Array) -> Array:
    return lax.bitcast_convert_type(bits, jnp.float32)
