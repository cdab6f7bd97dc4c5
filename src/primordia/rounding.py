"""Arithmetic that every compiler rounds alike."""

import jax.numpy as jnp
import numpy as np
from jax import Array, lax


def rounded_product(a: Array, positive: Array) -> Array:
    """Return a x positive in float32, rounded before anything is added to it.

    Left alone, compilers contract product and sum into a fused multiply-add, which rounds once: then
    24 of 60 weights differed from what two IEEE operations give. The sign bit of a number that is
    never negative is a zero they cannot know, and an integer operation they cannot contract across.
    """
    product = lax.bitcast_convert_type(a * positive, jnp.uint32)
    nothing = lax.bitcast_convert_type(positive, jnp.uint32) >> np.uint32(31)
    return lax.bitcast_convert_type(product ^ nothing, jnp.float32)
