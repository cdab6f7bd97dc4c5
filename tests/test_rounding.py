"""Products that are rounded before a sum."""

import jax
import numpy as np

from primordia.rounding import rounded_product


def test_compiled_code_rounds_a_product_before_a_sum() -> None:
    """The bits are those of NumPy, for both signs, zero and infinity. NaN gives NaN."""
    rng = np.random.default_rng(1)
    a, b, c = rng.normal(size=(3, 64)).astype(np.float32)
    b = np.abs(b)
    a[:6] = [0, -0.0, np.inf, -np.inf, np.nan, 1e-44]
    b[:6] = [3, 3, 2, 2, 1, 1]
    b[6:8] = [0, np.inf]
    found = jax.jit(lambda *x: (rounded_product(x[0], x[1]), rounded_product(x[0], x[1]) + x[2]))(
        a, b, c
    )
    keep = np.arange(64) != 4  # the bits of NaN are not compared
    product = a * b
    assert np.isnan(found[0][4])
    normal = keep & (np.arange(64) != 5)  # XLA rounds the smallest numbers to zero
    assert np.asarray(found[0])[normal].tobytes() == product[normal].tobytes()
    assert np.asarray(found[1])[normal].tobytes() == (product + c)[normal].tobytes()
