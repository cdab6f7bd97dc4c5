"""Functions of JAX whose products and sums are rounded in the same way in every program.

A compiler may contract a product and a sum into a fused multiply-add, which rounds once. Whether the
compiler does so depends on what else the program computes: the results of gymnax's Pendulum in a
loop differed from those tick by tick. Here the operations of a function are executed one by one.
An integer operation follows each float32 product to which something may be added. It changes
nothing, but the compiler does not know this (see `primordia.rounding`). Sums over axes, also those
of matrix products, are trees of additions, whatever the number of bodies.
"""

from collections.abc import Callable, Sequence
from functools import partial
from math import prod
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array, lax
from jax.extend.core import ClosedJaxpr, Jaxpr, Literal

INLINED = {"jit": "jaxpr", "closed_call": "call_jaxpr", "custom_jvp_call": "call_jaxpr"}
"""Primitives that only call a function, and their parameter that holds this function."""

PRODUCTS = {"mul", "square"}
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


def rounded(function: Callable, zero: Array) -> Callable:
    """Return the function with every product of float32 rounded before anything is added to it.

    `zero` is uint32 (), 0 in every program, and must not be known to the compiler.
    """

    def compute(*arguments: Any) -> Any:
        jaxpr, shapes = jax.make_jaxpr(function, return_shape=True)(*arguments)
        outputs = _Rounded(zero).closed(jaxpr, *jax.tree.leaves(arguments))
        return jax.tree.unflatten(jax.tree.structure(shapes), outputs)

    return compute


def uses_first(function: Callable, *arguments: Any) -> bool:
    """Return whether a function uses its first argument; `arguments` may be mere shapes."""
    jaxpr = jax.make_jaxpr(function)(*arguments).jaxpr
    used = [variable for equation in jaxpr.eqns for variable in equation.invars]
    return any(variable is jaxpr.invars[0] for variable in [*used, *jaxpr.outvars])


class _Rounded:
    """An interpreter of JAX's own representation of functions."""

    def __init__(self, zero: Array) -> None:
        self._zero = zero

    def closed(self, function: ClosedJaxpr, *arguments: Any) -> list[Any]:
        return self._execute(function.jaxpr, function.consts, arguments)

    def _execute(self, function: Jaxpr, consts: Sequence, arguments: Sequence) -> list[Any]:
        values = dict(
            zip([*function.constvars, *function.invars], [*consts, *arguments], strict=True)
        )

        def read(variable: Any) -> Any:
            return variable.val if isinstance(variable, Literal) else values[variable]

        added = _may_be_added(function)
        for equation in function.eqns:
            inputs = [read(variable) for variable in equation.invars]
            name = equation.primitive.name
            own = getattr(self, f"_{name}", None)
            if name in INLINED:
                outputs = self.closed(equation.params[INLINED[name]], *inputs)
            elif own is not None and (name not in PRODUCTS or added.issuperset(equation.outvars)):
                outputs = own(*inputs, **equation.params)
            else:
                outputs = equation.primitive.bind(*inputs, **equation.params)
                outputs = outputs if equation.primitive.multiple_results else [outputs]
            values.update(zip(equation.outvars, outputs, strict=True))
        return [read(variable) for variable in function.outvars]

    def _product(self, a: Any, b: Any) -> Any:
        product = lax.mul(a, b)
        if product.dtype != jnp.float32:
            return product
        bits = lax.bitcast_convert_type(product, jnp.uint32)
        return lax.bitcast_convert_type(bits ^ self._zero, jnp.float32)

    def _mul(self, a: Any, b: Any, **_: Any) -> list[Any]:
        return [self._product(a, b)]

    def _square(self, a: Any, **_: Any) -> list[Any]:
        return [self._product(a, a)]

    def _integer_pow(self, a: Any, y: int, **_: Any) -> list[Any]:
        power, square, left = None, a, abs(y)
        while left:
            if left % 2:
                power = square if power is None else self._product(power, square)
            square, left = self._product(square, square), left // 2
        power = jnp.ones_like(a) if power is None else power
        return [lax.div(jnp.ones_like(a), power) if y < 0 else power]

    def _reduce_sum(self, a: Any, axes: Sequence[int], **options: Any) -> list[Any]:
        if a.dtype != jnp.float32:
            return [lax.reduce_sum_p.bind(a, axes=axes, **options)]
        return [_summed(jnp.moveaxis(a, axes, range(len(axes))), len(axes))]

    def _dot_general(self, a: Any, b: Any, dimension_numbers: Any, **options: Any) -> list[Any]:
        if a.dtype != jnp.float32 or b.dtype != jnp.float32:
            return [lax.dot_general_p.bind(a, b, dimension_numbers=dimension_numbers, **options)]
        summed, batch = dimension_numbers
        shared = len(summed[0]) + len(batch[0])
        a, b = (
            jnp.moveaxis(each, (*over, *beside), range(shared))
            for each, over, beside in zip((a, b), summed, batch, strict=True)
        )
        a, b = (
            a.reshape(*a.shape, *[1] * (b.ndim - shared)),
            b.reshape(*b.shape[:shared], *[1] * (a.ndim - shared), *b.shape[shared:]),
        )
        return [_summed(self._product(a, b), len(summed[0]))]

    def _cond(self, index: Any, *operands: Any, branches: Sequence, **_: Any) -> list[Any]:
        return lax.switch(index, [partial(self.closed, branch) for branch in branches], *operands)

    def _while(
        self,
        *inputs: Any,
        cond_jaxpr: ClosedJaxpr,
        body_jaxpr: ClosedJaxpr,
        cond_nconsts: int,
        body_nconsts: int,
        **_: Any,
    ) -> Any:
        of_cond, rest = inputs[:cond_nconsts], inputs[cond_nconsts:]
        of_body, carry = rest[:body_nconsts], rest[body_nconsts:]
        return lax.while_loop(
            lambda carry: self.closed(cond_jaxpr, *of_cond, *carry)[0],
            lambda carry: self.closed(body_jaxpr, *of_body, *carry),
            list(carry),
        )

    def _scan(
        self,
        *inputs: Any,
        jaxpr: ClosedJaxpr,
        num_consts: int,
        num_carry: int,
        length: int,
        reverse: bool,
        unroll: int,
        **_: Any,
    ) -> list[Any]:
        consts, rest = inputs[:num_consts], inputs[num_consts:]

        def step(carry: list[Any], each: list[Any]) -> tuple[list[Any], list[Any]]:
            outputs = self.closed(jaxpr, *consts, *carry, *each)
            return outputs[:num_carry], outputs[num_carry:]

        carry, stacked = lax.scan(
            step, list(rest[:num_carry]), list(rest[num_carry:]), length, reverse, unroll
        )
        return [*carry, *stacked]


def _may_be_added(function: Jaxpr) -> set[Any]:
    """Return the variables to which something may be added: not all of their users are in NO_SUM."""
    adding = [each for each in function.eqns if each.primitive.name not in NO_SUM]
    used = [*function.outvars, *(variable for each in adding for variable in each.invars)]
    return {variable for variable in used if not isinstance(variable, Literal)}


def _summed(a: Array, axes: int) -> Array:
    """Return the sum over the first axes, in the same order for arrays of all shapes."""
    a = a.reshape(prod(a.shape[:axes]), *a.shape[axes:])  # also for an empty axis
    while (count := len(a)) > 1:
        half = (count + 1) // 2
        a = jnp.concatenate([a[: count // 2] + a[half:], a[count // 2 : half]])
    return a.sum(axis=0)
