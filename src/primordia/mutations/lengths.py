"""Lengths of mutations as whole numbers of quarters of an octave, so that rounding errors never add
up."""

import jax.numpy as jnp
import numpy as np
from jax import Array

SHORTEST, LONGEST = -96, 32
"""Quarters of an octave: lengths go from 2^-24 to 2^8."""
WITHIN_OCTAVE = (1.0, 1.1892071, 1.4142135, 1.6817929)
"""2^(0/4) to 2^(3/4). No library's power function is used, so all machines have the same table."""
LENGTHS = np.array(
    [np.ldexp(np.float32(WITHIN_OCTAVE[n % 4]), n // 4) for n in range(SHORTEST, LONGEST + 1)],
    np.float32,
)


def length(quarters: Array) -> Array:
    """Return 2^(quarters / 4), float32; `quarters` is int32, from SHORTEST to LONGEST."""
    return jnp.asarray(LENGTHS)[quarters - SHORTEST]
