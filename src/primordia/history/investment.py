"""What parents give to their children, over births, if replication is an act."""

from typing import NamedTuple

import numpy as np

from primordia.law.metabolism import ONE
from primordia.runs.records import Records

BINS, ENOUGH = 50, 20
"""Largest number of bins, and the births needed for each."""


class Investment(NamedTuple):
    """The endowments of children in B bins of births."""

    middle: np.ndarray
    """the middle of each bin, in organisms born so far, float64 (B,)"""
    endowment: np.ndarray
    """mean energy that a child begins with, in each world, float64 (W, B); NaN without a child"""


def investment(run: Records) -> Investment:
    """Return the mean endowments of children over births. Founders do not count."""
    lives = run.lives
    given, rank = run.endowments_of(lives) / ONE, lives.rank
    child = (lives.parent >= 0) & ~lives.inherited
    longest = int(rank.max()) + 1
    edges = np.linspace(0, longest, int(np.clip(longest // ENOUGH, 1, BINS)) + 1)
    found = np.full((lives.worlds, len(edges) - 1), np.nan)
    for world in range(lives.worlds):
        own = child & (lives.world == world)
        count, total = (np.histogram(rank[own], edges, weights=w)[0] for w in (None, given[own]))
        found[world] = np.where(count, total / np.maximum(count, 1), np.nan)
    return Investment((edges[:-1] + edges[1:]) / 2, found)
