"""Sums of environments in JAX, in the same order for every number of bodies."""

from typing import Any

import jax
import numpy as np
from jax import lax

from primordia.compiled import jit
from primordia.habitats.gymnax.sums import ordered


def test_a_sum_over_nothing_is_zero_and_nothing_has_no_sums() -> None:
    def products(a: Any, b: Any) -> Any:
        return a @ b, b.T @ a.T, b.sum(axis=0)

    a = np.ones((0, 3), np.float32)
    for b in (np.ones((3, 2), np.float32), np.ones((3, 0), np.float32)):
        for one, other in zip(jit(ordered(products))(a, b), products(a, b), strict=True):
            np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(jit(ordered(lambda a: a.T @ a))(a), np.zeros((3, 3)))


def test_sums_and_products_of_a_row_do_not_depend_on_the_number_of_rows() -> None:
    rng = np.random.default_rng(1)
    rows, weights = (rng.normal(size=(size, 100)).astype(np.float32) for size in (32, 5))

    def summed(rows: Any) -> Any:
        return jax.vmap(lambda row: (weights @ row, row.mean()))(rows)

    for many, alone in zip(jit(ordered(summed))(rows), jit(ordered(summed))(rows[:1]), strict=True):
        np.testing.assert_array_equal(many[:1], alone)


def test_sums_and_matrix_products_are_those_of_numpy() -> None:
    rng = np.random.default_rng(0)
    a, b = rng.normal(size=(3, 5, 7, 2)), rng.normal(size=(7, 4, 3))
    whole = rng.integers(9, size=(5, 3))

    def sums(a: Any, b: Any, whole: Any) -> Any:
        product = lax.dot_general(a, b, (((2,), (0,)), ((0,), (2,))))
        integers = whole.sum(0), whole @ whole.T
        twice = lax.dot_general(a, b, (((2, 0), (0, 2)), ((), ())))
        return product, twice, a.sum(), a.sum(axis=(1, 3)), a[:, :, :0].sum(axis=2), *integers

    found = jax.jit(ordered(sums))(a.astype(np.float32), b.astype(np.float32), whole)
    expected = (
        np.einsum("nikj,kln->nijl", a, b), np.einsum("nikj,kln->ijl", a, b), a.sum(),
        a.sum(axis=(1, 3)), np.zeros((3, 5, 2)), whole.sum(0), whole @ whole.T,
    )  # fmt: skip
    for one, other in zip(found, expected, strict=True):
        assert one.shape == np.shape(other)
        np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-5)
