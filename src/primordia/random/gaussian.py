"""The standard Gaussian as a table of 65,536 quantiles; 16 random bits choose one of them.

The table is made on the host in float32, so it has the same bits on any device. The tails end at +-4.32
standard deviations.
"""

import hashlib
from functools import cache
from statistics import NormalDist

import numpy as np

QUANTILES_SHA256 = "1cfbba1e07e34386a57626f82aeb43e6ed54ba70a3ea6b7d964dc66a841074a8"


@cache
def quantiles() -> np.ndarray:
    """Return the standard Gaussian's quantiles at (i + 1/2) / 65536, float32 (65536,), increasing.

    Raises:
        RuntimeError: the quantiles differ from those of other machines.
    """
    inverse = NormalDist().inv_cdf
    upper = np.array([inverse((i + 0.5) / 65536) for i in range(32768, 65536)], np.float32)
    table = np.concatenate([-upper[::-1], upper])
    if hashlib.sha256(table.astype("<f4").tobytes()).hexdigest() != QUANTILES_SHA256:
        raise RuntimeError(
            "this machine's C library gives different Gaussian quantiles, so genomes would differ"
            " from those of other machines; use another Python or C library"
        )
    return table


@cache
def sparse(share: float) -> np.ndarray:
    """Return a table like `quantiles`, of which only this share (2^-15 to 1) differs from zero.

    These entries, at both ends of the table, are quantiles of the standard Gaussian, evenly chosen.
    """
    half = len(quantiles()) // 2
    count, upper = round(share * half), quantiles()[half:]
    table = np.zeros_like(quantiles())
    chosen = upper[(2 * np.arange(count) + 1) * half // (2 * count)]
    table[:count], table[-count:] = -chosen[::-1], chosen
    return table
