"""Layers compared with their formulas in NumPy."""

from typing import Any

import jax
import numpy as np
import pytest
from jax.lax import Precision

from primordia.brains.layers import gate, layer, linear, matvec, mix


def normal(*shape: int) -> np.ndarray:
    return np.random.default_rng(0).normal(size=shape).astype(np.float32)


def times(weights: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return W x in float64; W (K, *) stores its longer side last, and inputs first if both are equal."""
    inputs_first = weights.shape[1] == x.shape[1]
    return np.einsum("kio,ki->ko" if inputs_first else "koi,ki->ko", weights.astype(float), x)


def test_products_keep_all_bits_of_float32_on_every_device() -> None:
    """By default a GPU rounds the factors to fewer bits."""
    (product,) = (
        each
        for each in jax.make_jaxpr(matvec)(normal(3, 4, 32), normal(3, 4)).eqns
        if each.primitive.name == "dot_general"
    )
    assert product.params["precision"] in (Precision.HIGHEST, (Precision.HIGHEST,) * 2)


@pytest.mark.parametrize(
    ("inputs", "outputs", "shape"), [(4, 32, (4, 32)), (32, 4, (4, 32)), (7, 7, (7, 7))]
)
def test_a_layer_stores_the_longer_axis_last_and_a_bias_in_a_separate_block(
    inputs: int, outputs: int, shape: tuple[int, int]
) -> None:
    assert layer("w", inputs, outputs) == {"w": shape}
    blocks = layer("w", inputs, outputs, bias=True)
    assert blocks == {"w": shape, "w_bias": (outputs,)}
    genome: dict[str, Any] = {name: normal(3, *each) for name, each in blocks.items()}
    x = normal(3, inputs)
    expected = times(genome["w"], x) + genome["w_bias"]
    np.testing.assert_allclose(linear(genome, "w", x), expected, rtol=1e-4, atol=1e-4)
    product = linear({"w": genome["w"]}, "w", x)
    np.testing.assert_array_equal(product, matvec(genome["w"], x))
    np.testing.assert_allclose(product, times(genome["w"], x), rtol=1e-4, atol=1e-4)


def test_a_gate_is_the_logistic_function() -> None:
    x = np.append(np.linspace(-20, 20, 401), [-np.inf, 0, np.inf, np.nan]).astype(np.float32)
    found = np.asarray(gate(x))
    np.testing.assert_allclose(found[:401], 1 / (1 + np.exp(-x[:401].astype(float))), atol=2e-7)
    np.testing.assert_array_equal(found[401:], [0, 0.5, 1, np.nan])


def test_a_mixture_goes_from_one_to_the_other() -> None:
    share, a, b = np.random.default_rng(1).random((3, 1000), np.float32) + np.float32(1e-3)
    rounded = share * a + (np.float32(1) - share) * b
    np.testing.assert_array_equal(mix(np.minimum(share, 1), a, b), np.where(share > 1, a, rounded))
    np.testing.assert_array_equal(mix(np.ones_like(a), a, b), a)
    np.testing.assert_array_equal(mix(np.zeros_like(a), a, b), b)
