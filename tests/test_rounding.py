"""Products that are rounded before a sum."""

import jax
import numpy as np
import pytest

from primordia.rounding import rounded_product

PRODUCT = jax.jit(rounded_product)
SUM = jax.jit(lambda a, b, c: rounded_product(a, b) + c)


@pytest.mark.usefixtures("optimised")
def test_compiled_code_rounds_a_product_before_a_sum() -> None:
    """The bits are those of NumPy, for both signs, zero and infinity. NaN gives NaN."""
    rng = np.random.default_rng(1)
    a, b, c = rng.normal(size=(3, 64)).astype(np.float32)
    b = np.abs(b)
    a[:6] = [0, -0.0, np.inf, -np.inf, np.nan, 1e-44]
    b[:6] = [3, 3, 2, 2, 1, 1]
    b[6:8] = [0, np.inf]
    assert np.isnan(PRODUCT(a, b)[4])
    # The bits of NaN are not compared, and XLA rounds the smallest numbers to zero.
    a, b, c = (np.delete(each, [4, 5]) for each in (a, b, c))
    assert np.asarray(PRODUCT(a, b)).tobytes() == (a * b).tobytes()
    assert np.asarray(SUM(a, b, c)).tobytes() == (a * b + c).tobytes()
