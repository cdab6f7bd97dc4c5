"""Arithmetic that every compiler rounds alike."""

import jax.numpy as jnp
import numpy as np
from jax import Array, lax


def rounded_product(a: Array, positive: Array) -> Array:
    """Return the product of `a` and `positive` in float32, rounded before anything is added to it.

    A compiler may contract a product and a sum into a fused multiply-add, which rounds once. With
    such contractions, 24 of 60 weights of children differed from the results of two IEEE
    operations. The sign bit of a number that is never negative is zero, which the compiler does not
    know. So the integer operation prevents the contraction.
    """
    product = lax.bitcast_convert_type(a * positive, jnp.uint32)
    sign_bit = lax.bitcast_convert_type(positive, jnp.uint32) >> np.uint32(31)
    return lax.bitcast_convert_type(product ^ sign_bit, jnp.float32)
