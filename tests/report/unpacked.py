"""What the browser makes of packed arrays, in Python."""

import base64
import gzip
import json
import re
from pathlib import Path
from typing import Any

import numpy as np


def unpacked(value: dict[str, Any]) -> np.ndarray:
    """Return the numbers of a packed array, (n,)."""
    raw = gzip.decompress(base64.b64decode(value["data"], validate=True))
    numbers = np.frombuffer(raw, np.dtype(value["type"]).newbyteorder("<"))
    numbers = np.cumsum(numbers.astype(np.float64)) if value["rising"] else numbers
    return numbers.astype(np.int64)


def all_unpacked(group: dict[str, Any]) -> dict[str, np.ndarray]:
    """Return the packed arrays of a group, by name."""
    return {
        name: unpacked(value)
        for name, value in group.items()
        if isinstance(value, dict) and "data" in value
    }


def content_of(page: Path) -> dict[str, Any]:
    """Return the content of a page."""
    (text,) = re.findall(r'<script type="application/json"[^>]*>(.*?)</script>', page.read_text())
    return json.loads(text)
