"""Arrays in a page: typed, compressed, and written in base64; `arrays.js` reads them."""

import base64
import gzip
from typing import Any

import numpy as np


def packed(values: np.ndarray, rising: bool = False) -> dict[str, Any]:
    """Return an array of non-negative numbers as JSON values.

    Args:
        values: non-negative integers of any shape; values of 2^32 and more become float64, which is
            exact up to 2^53.
        rising: whether the values never decrease; then their differences are stored, which are
            shorter.

    Returns:
        `type`: uint8, uint16, uint32 or float64, little-endian; `rising`; `data`: the values in C
        order, compressed by gzip (RFC 1952), in base64 (RFC 4648).
    """
    flat = np.asarray(values).ravel()
    kept = np.diff(flat, prepend=flat.dtype.type(0)) if rising else flat
    most = int(kept.max(initial=0))
    fitting = (kind for kind in ("uint8", "uint16", "uint32") if most <= np.iinfo(kind).max)
    kind = next(fitting, "float64")
    raw = kept.astype(np.dtype(kind).newbyteorder("<")).tobytes()
    data = base64.b64encode(gzip.compress(raw, mtime=0)).decode("ascii")
    return {"type": kind, "rising": rising, "data": data}
