"""Compiled code rounds each result as it is written, whatever the compiler."""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from primordia.compiled import jit


def test_loops_branches_and_powers_are_those_of_numpy() -> None:
    """A power is a product of squares, smallest first."""
    a = np.float32([0.3, -1.7, 2.9])
    rows = np.float32([[0.1, 0.2, 0.3], [1.1, -1.2, 1.3], [7.0, 8.0, 9.0]])

    def powers(a: Any, rows: Any) -> Any:
        def step(x: Any, row: Any) -> Any:
            return x * row + 1, x - row

        last, passed = lax.scan(step, a, rows, reverse=True)
        grown = lax.while_loop(lambda x: x[0] < 9, lambda x: x * x + a * a, a + 1)
        return [lax.integer_pow(a, y) for y in (0, 1, 2, 5, 6, -1, -3)], last, passed, grown

    found, last, passed, grown = jit(powers)(a, rows)
    two, one = a * a, np.float32(1)
    four = two * two
    expected = [a * 0 + 1, a, two, a * four, two * four, one / a, one / (a * two)]
    for power, wanted in zip(found, expected, strict=True):
        np.testing.assert_array_equal(power, wanted)
    x, seen = a, []
    for row in rows[::-1]:
        x, before = x * row + 1, x - row
        seen.append(before)
    np.testing.assert_array_equal(last, x)
    np.testing.assert_array_equal(passed, seen[::-1])
    x = a + 1
    while x[0] < 9:
        x = x * x + two
    np.testing.assert_array_equal(grown, x)


def test_every_product_is_rounded_before_it_is_added() -> None:
    rng = np.random.default_rng(0)
    a, b, c = (rng.normal(size=500).astype(np.float32) for _ in range(3))

    def sums(a: Any, b: Any, c: Any) -> Any:
        branch = lax.cond(c[0] > 9, lambda: a, lambda: a * b + c)
        loop = lax.fori_loop(0, 3, lambda i, x: x * b + c, a)
        scanned = lax.scan(lambda x, y: (x * y + c, x), a, jnp.stack([b, a]))
        own = jax.custom_jvp(lambda a, b: a * b + c)
        own.defjvp(lambda given, change: (own(*given), change[0]))
        again = jax.checkpoint(lambda a: a * b)(a) + c
        dots = lax.dot_general(a[:, None], b[:, None], (((1,), (1,)), ((0,), (0,)))) + c
        negative = c - a * b
        return (
            branch,
            loop,
            *scanned,
            a**3 + c,
            jax.jit(jnp.square)(a) - c,
            own(a, b),
            again,
            dots,
            negative,
        )

    found = jit(sums)(a, b, c)
    once = a * b + c
    thrice = (once * b + c) * b + c
    expected = once, thrice, once * a + c, np.stack([a, once]), a * (a * a) + c, a * a - c
    expected = *expected, once, once, once, c - a * b
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one, other)


def test_rounding_changes_no_other_number() -> None:
    """Signs of zero, infinities, NaN and whole numbers are those of the product alone."""
    a = np.float32([0, -0.0, np.inf, -np.inf, np.nan, 1e-44, 3e38])
    b, whole = np.float32([3, 3, 2, -2, 1, 1e-3, 10]), np.int32([2**20, -5, 7])
    product, squares = jit(lambda a, b, whole: (a * b, whole * whole + 1))(a, b, whole)
    plain = np.asarray(jax.jit(jnp.multiply)(a, b))
    np.testing.assert_array_equal(product, plain)
    np.testing.assert_array_equal(np.signbit(product)[:2], [False, True])
    np.testing.assert_array_equal(squares, whole * whole + 1)


def test_a_mapped_loop_ends_for_each_by_itself() -> None:
    """Each has its own number of steps; JAX maps such a loop over many in a form of its own."""
    start = np.float32([[0.5, 7.0, 11.0], [3.0, 12.0, 0.1]])

    def grown(x: Any) -> Any:
        return lax.while_loop(lambda x: x[0] < 9, lambda x: (x[0] * 1.7 + 0.3, x[1] + 1), (x, 0))

    sizes, steps = map(np.asarray, jit(jax.vmap(jax.vmap(grown)))(start))
    for x, size, count in zip(start.ravel(), sizes.ravel(), steps.ravel(), strict=True):
        taken = 0
        while x < 9:
            x, taken = x * np.float32(1.7) + np.float32(0.3), taken + 1
        assert (size, count) == (x, taken)


def test_an_angle_does_not_depend_on_how_many_there_are() -> None:
    numbers = np.random.default_rng(0).normal(size=1024).astype(np.float32)
    compiled = jit(jnp.arctan)
    whole = np.asarray(compiled(numbers))
    np.testing.assert_allclose(whole, np.arctan(numbers), rtol=1e-6)
    for count in (1, 31, 100):
        np.testing.assert_array_equal(compiled(numbers[:count]), whole[:count])


def full(value: float, like: Any) -> Any:
    """Return a constant in the shape of an array, made by NumPy for an array of NumPy."""
    library: Any = np if isinstance(like, np.ndarray) else jnp
    return library.full(like.shape, np.float32(value))


A, B = np.float32(0.1), np.float32(0.37)


COMPUTED: list[Callable] = [
    lambda x, y, z: x + A + B,
    lambda x, y, z: x - A + B,
    lambda x, y, z: x + full(0.1, x) + full(0.3, x),
    lambda x, y, z: x * full(0.1, x) * full(0.3, x),
    lambda x, y, z: x / B,
    lambda x, y, z: x / B / A,
    lambda x, y, z: x / y[0],
    lambda x, y, z: x / y / z,
    lambda x, y, z: x / (y / z),
]


def test_constants_and_divisions_are_computed_as_they_are_written() -> None:
    """Without the cure each has other bits than NumPy's, at least with JAX 0.10.2."""
    numbers = np.random.default_rng(0).normal(size=(3, 1000)).astype(np.float32)
    compiled = jit(lambda *given: [each(*given) for each in COMPUTED])
    for count in (1, 31, 1000):
        given = numbers[:, :count]
        for number, (found, each) in enumerate(zip(compiled(*given), COMPUTED, strict=True)):
            np.testing.assert_array_equal(found, each(*given), err_msg=f"{number} of {count}")
