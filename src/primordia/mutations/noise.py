"""Gaussian noise for weights, with the same bits on every device.

Noise is read from the table of `random.gaussian`, with 16 random bits for each weight. A child's
weight is one IEEE product (quantile x scale) and one IEEE sum; see `rounding`.
"""

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.random.gaussian import sparse
from primordia.random.keys import bits
from primordia.random.wide import Wide


def standard_noise(stream: Wide, cell: Array, length: int, share: float = 1.0) -> Array:
    """Return standard Gaussian noise for K streams and cells (K,): float32 (K, length).

    Each number is 0 with probability `1 - share`.
    """
    return jnp.asarray(sparse(share))[noise_index(stream, cell, length)]


def noise_index(stream: Wide, cell: Array, length: int) -> Array:
    """Return the index of each weight's noise in the table, for K streams and cells: int32 (K,
    length).

    With m = ceil(length / 4), weight i takes the (i // m)-th 16 bits of draw i % m.
    """
    draws = jnp.arange(-(-length // 4), dtype=jnp.uint32)
    a, b = bits(stream.take(np.s_[:, None]), cell[:, None], draws)
    low, high = np.uint32(0xFFFF), np.uint32(16)
    quarters = jnp.concatenate([a & low, a >> high, b & low, b >> high], axis=1)
    return quarters[:, :length].astype(jnp.int32)
