"""Saved states of simulators, bytes of any length, as arrays with a row for each cell."""

from collections.abc import Mapping

import numpy as np


def packed(states: list[bytes]) -> dict[str, np.ndarray]:
    """Return states, padded to one length, uint8 (N, L), and their lengths, int64 (N,)."""
    lengths = np.array([len(state) for state in states])
    rows = np.zeros((len(states), lengths.max()), np.uint8)
    for row, state in zip(rows, states, strict=True):
        row[: len(state)] = np.frombuffer(state, np.uint8)
    return {"states": rows, "lengths": lengths}


def unpacked(arrays: Mapping[str, np.ndarray]) -> list[bytes]:
    """Return the states that `packed` stored."""
    pairs = zip(arrays["states"], arrays["lengths"], strict=True)
    return [row[:length].tobytes() for row, length in pairs]
