"""Functions of JAX, executed with replacements for some of their operations.

JAX represents a function as equations, each of which applies a primitive to arrays. They are executed
one by one, as JAX's guide "Writing custom Jaxpr interpreters in JAX" shows. Loops and branches are
made again by the public `while_loop`, `scan` and `switch`. Which inputs of a loop are constants and which
are carried follows from their numbers and shapes, since versions of JAX differ in what they say of it.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Any, TypeAlias

import jax
import jax.numpy as jnp
from jax import Array, lax
from jax.extend.core import ClosedJaxpr, Jaxpr, JaxprEqn, Literal

Rule: TypeAlias = Callable[[JaxprEqn, list[Any], list[bool]], Array]
"""Return the output of an equation for its inputs, given which of these are constants."""
FLOAT32 = jnp.dtype(jnp.float32)


def rewritten(function: Callable, rules: Mapping[str, Rule]) -> Callable:
    """Return a function of trees of arrays with replaced operations, in loops and branches too.

    Args:
        function: the function.
        rules: for a primitive's name, what replaces its equations whose output is float32.
    """

    def compute(*arguments: Any) -> Any:
        jaxpr, shapes = jax.make_jaxpr(function, return_shape=True)(*arguments)
        outputs = _Rewriter(rules)(jaxpr, *jax.tree.leaves(arguments))
        return jax.tree.unflatten(jax.tree.structure(shapes), outputs)

    return compute


def bind(equation: JaxprEqn, inputs: Sequence[Any]) -> Any:
    """Return the outputs of an equation as it is: a list if its primitive has several."""
    return equation.primitive.bind(*inputs, **equation.params)


def uses_first(function: Callable, *arguments: Any) -> bool:
    """Return whether a function uses its first argument; `arguments` may be mere shapes."""
    jaxpr = jax.make_jaxpr(function)(*arguments).jaxpr
    used = [variable for equation in jaxpr.eqns for variable in equation.invars]
    return any(variable is jaxpr.invars[0] for variable in [*used, *jaxpr.outvars])


class _Rewriter:
    """An interpreter of equations."""

    def __init__(self, rules: Mapping[str, Rule]) -> None:
        self._rules = rules
        self._constants: dict[int, Any] = {}
        """Traced values that follow from constants alone, by identity"""

    def __call__(self, function: Any, *arguments: Any) -> list[Any]:
        """Return the outputs of a function for these arguments."""
        jaxpr, consts = _opened(function)
        values = dict(zip([*jaxpr.constvars, *jaxpr.invars], [*consts, *arguments], strict=True))

        def read(variable: Any) -> Any:
            return variable.val if isinstance(variable, Literal) else values[variable]

        for equation in jaxpr.eqns:
            inputs = [read(each) for each in equation.invars]
            constant = [self._is_constant(each) for each in inputs]
            if self._has_rule(equation):
                outputs = [self._rules[equation.primitive.name](equation, inputs, constant)]
            else:
                outputs = self._apply(equation, inputs)
            if all(constant):
                self._constants |= {id(each): each for each in outputs}
            values.update(zip(equation.outvars, outputs, strict=True))
        return [read(variable) for variable in jaxpr.outvars]

    def _has_rule(self, equation: JaxprEqn) -> bool:
        named = equation.primitive.name in self._rules
        return named and getattr(equation.outvars[0].aval, "dtype", None) == FLOAT32

    def _is_constant(self, value: Any) -> bool:
        return id(value) in self._constants or not isinstance(value, jax.core.Tracer)

    def _concerns(self, function: Any) -> bool:
        """Return whether a function has an operation with a rule, at any depth."""
        return any(
            self._has_rule(equation) or any(map(self._concerns, _functions(equation)))
            for equation in _opened(function)[0].eqns
        )

    def _apply(self, equation: JaxprEqn, inputs: list[Any]) -> list[Any]:
        """Return the outputs of an equation without a rule of its own."""
        name, functions = equation.primitive.name, list(_functions(equation))
        if any(map(self._concerns, functions)):
            if name in ("while", "scan", "cond"):
                return getattr(self, f"_{name}")(equation, inputs)
            if _shapes(_opened(functions[0])[0].invars) == _shapes(equation.invars):
                return self(functions[0], *inputs)  # a call, such as that of a compiled function
        outputs = bind(equation, inputs)
        return outputs if equation.primitive.multiple_results else [outputs]

    def _cond(self, equation: JaxprEqn, inputs: list[Any]) -> list[Any]:
        index, *given = inputs  # the branches close over what is given: constants stay constants
        return lax.switch(
            index, [partial(self, each, *given) for each in equation.params["branches"]]
        )

    def _while(self, equation: JaxprEqn, inputs: list[Any]) -> list[Any]:
        condition, body = equation.params["cond_jaxpr"], equation.params["body_jaxpr"]
        carried = len(equation.outvars)
        ends = len(_opened(condition)[0].invars) - carried
        begins = len(inputs) - carried

        def goes_on(carry: list[Any]) -> Array:
            return self(condition, *inputs[:ends], *carry)[0]

        def step(carry: list[Any]) -> list[Any]:
            return self(body, *inputs[ends:begins], *carry)

        def step_those_that_go_on(carry: list[Any]) -> list[Any]:
            going = goes_on(carry)
            pairs = zip(step(carry), carry, strict=True)
            return [lax.select(_spread(going, old.shape), new, old) for new, old in pairs]

        if _shapes(_opened(condition)[0].outvars)[0][0]:  # a loop that was mapped over many
            return lax.while_loop(
                lambda carry: goes_on(carry).any(), step_those_that_go_on, inputs[begins:]
            )
        return lax.while_loop(goes_on, step, inputs[begins:])

    def _scan(self, equation: JaxprEqn, inputs: list[Any]) -> list[Any]:
        body, inner = equation.params["jaxpr"], _opened(equation.params["jaxpr"])[0]
        carried = _unsliced(equation.outvars, inner.outvars)
        sliced = _unsliced(equation.invars, inner.invars)
        consts, carry = inputs[: sliced - carried], inputs[sliced - carried : sliced]

        def step(carry: list[Any], each: list[Any]) -> tuple[list[Any], list[Any]]:
            outputs = self(body, *consts, *carry, *each)
            return outputs[:carried], outputs[carried:]

        options = {name: equation.params[name] for name in ("length", "reverse", "unroll")}
        carry, stacked = lax.scan(step, carry, inputs[sliced:], **options)
        return [*carry, *stacked]


def _opened(function: Any) -> tuple[Jaxpr, Sequence[Any]]:
    """Return a function's equations and constants; some versions of JAX keep both in one object."""
    return getattr(function, "jaxpr", function), getattr(function, "consts", ())


def _functions(equation: JaxprEqn) -> Iterator[Any]:
    """Yield the functions among an equation's parameters."""
    for value in equation.params.values():
        for each in value if isinstance(value, tuple | list) else (value,):
            if isinstance(each, ClosedJaxpr | Jaxpr):
                yield each


def _shapes(variables: Sequence[Any]) -> list[tuple]:
    return [(each.aval.shape, each.aval.dtype) for each in variables]


def _spread(mask: Array, shape: tuple[int, ...]) -> Array:
    """Return a mask of the first axes of an array for all of the array's elements."""
    return lax.broadcast_in_dim(mask, shape, range(mask.ndim))


def _unsliced(outside: Sequence[Any], inside: Sequence[Any]) -> int:
    """Return how many variables of a scan have as many axes inside it as outside; they come first."""
    pairs = zip(outside, inside, strict=True)
    return sum(a.aval.ndim == b.aval.ndim for a, b in pairs)
