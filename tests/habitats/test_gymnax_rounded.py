"""Arithmetic of environments in JAX, in which every product is rounded before it is added."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from primordia.habitats.gymnax.habitat import Gymnax
from primordia.habitats.gymnax.rounded import rounded
from primordia.testing import check_habitat


def test_powers_and_scans_are_those_of_numpy() -> None:
    """A power is a product of squares, smallest first. Each product is rounded."""
    a = np.float32([0.3, -1.7, 2.9])
    rows = np.float32([[0.1, 0.2, 0.3], [1.1, -1.2, 1.3], [7.0, 8.0, 9.0]])

    def powers(a: Any, rows: Any) -> Any:
        def step(x: Any, row: Any) -> Any:
            return x * row + 1, x - row

        last, passed = lax.scan(step, a, rows, reverse=True)
        grown = lax.while_loop(lambda x: x[0] < 9, lambda x: x * x + a * a, a + 1)
        return [lax.integer_pow(a, y) for y in (0, 1, 2, 5, 6, -1, -3)], last, passed, grown

    found, last, passed, grown = rounded(powers, jnp.uint32(0))(a, rows)
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


def test_every_product_is_rounded_before_it_is_added(optimised: None) -> None:
    rng = np.random.default_rng(0)
    a, b, c = (rng.normal(size=500).astype(np.float32) for _ in range(3))

    def sums(a: Any, b: Any, c: Any) -> Any:
        branch = lax.cond(c[0] > 9, lambda: a, lambda: a * b + c)
        loop = lax.fori_loop(0, 3, lambda i, x: x * b + c, a)
        scanned = lax.scan(lambda x, y: (x * y + c, None), a, jnp.stack([b, a]))[0]
        own = jax.custom_jvp(lambda a, b: a * b + c)
        own.defjvp(lambda given, change: (own(*given), change[0]))
        rows = (jnp.stack([a, c]) * b).sum(axis=0)
        return branch, loop, scanned, a**3 + c, jax.jit(jnp.square)(a) - c, own(a, b), rows, a * b

    def program(zero: Any, *each: Any) -> Any:
        *others, product = rounded(sums, zero)(*each)
        return *others, product + each[2]

    found = jax.jit(program)(np.uint32(0), a, b, c)
    thrice = ((a * b + c) * b + c) * b + c
    expected = a * b + c, thrice, (a * b + c) * a + c, a * (a * a) + c, a * a - c
    expected = *expected, a * b + c, a * b + c * b, a * b + c
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_sum_over_nothing_is_zero_and_nothing_has_no_sums() -> None:
    def products(a: Any, b: Any) -> Any:
        return a @ b, b.T @ a.T, b.sum(axis=0)

    zero, a = np.uint32(0), np.ones((0, 3), np.float32)
    for b in (np.ones((3, 2), np.float32), np.ones((3, 0), np.float32)):
        for one, other in zip(rounded(products, zero)(a, b), products(a, b), strict=True):
            np.testing.assert_array_equal(one, other)
    one = rounded(lambda a: a.T @ a, zero)(a)
    np.testing.assert_array_equal(one, np.zeros((3, 3)))


def test_sums_and_matrix_products_do_not_depend_on_the_number_of_bodies(optimised: None) -> None:
    check_habitat(Gymnax(env="tests.walks:Turning"))


def test_sums_and_matrix_products_are_those_of_numpy() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(3, 5, 7, 2)), rng.normal(size=(7, 4, 3))
    whole = rng.integers(9, size=(5, 3))

    def sums(a: Any, b: Any, whole: Any) -> Any:
        product = lax.dot_general(a, b, (((2,), (0,)), ((0,), (2,))))
        integers = whole.sum(0), whole @ whole.T
        twice = lax.dot_general(a, b, (((2, 0), (0, 2)), ((), ())))
        return product, twice, a.sum(), a.sum(axis=(1, 3)), a[:, :, :0].sum(axis=2), *integers

    found = jax.jit(lambda zero, *each: rounded(sums, zero)(*each))(
        np.uint32(0), a.astype(np.float32), b.astype(np.float32), whole
    )
    expected = (
        np.einsum("nikj,kln->nijl", a, b), np.einsum("nikj,kln->ijl", a, b), a.sum(),
        a.sum(axis=(1, 3)), np.zeros((3, 5, 2)), whole.sum(0), whole @ whole.T,
    )  # fmt: skip
    for one, other in zip(found, expected, strict=True):
        assert one.shape == np.shape(other)
        np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-5)
