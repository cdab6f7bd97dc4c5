"""Ancestors and children in one world, for all of its organisms at once."""

import numpy as np

ROWS = 4096
"""Organisms that are looked at together."""
FEW = 8
"""Lines up to which Python follows each sooner than NumPy all of them."""


def nearest(parent_row: np.ndarray, marked: np.ndarray) -> np.ndarray:
    """Return the nearest marked organism on each one's line of descent, itself included; its row or -1.

    Args:
        parent_row: row of each parent, or -1, int64 (L,), parents before their children.
        marked: rows, int64.
    """
    found = np.full(len(parent_row) + 1, -1)  # the last is that of no parent, -1
    found[marked] = marked
    for first in range(0, len(parent_row), ROWS):
        parent = parent_row[first : first + ROWS]
        own = np.arange(len(parent))
        known = (found[first : first + ROWS][: len(own)] >= 0) | (parent < first)
        start = np.where(known, own, parent - first)
        while (start != (further := start[start])).any():  # the way is doubled in each step
            start = further
        before = np.where(found[first + own] >= 0, first + own, found[parent])
        found[first + own] = before[start]
    return found[:-1]


def with_ancestors(rows: np.ndarray, *parents: np.ndarray) -> np.ndarray:
    """Return the rows of some organisms and all their ancestors, rising, int64.

    Args:
        rows: rows of the organisms, int64.
        parents: row of each one's first parent, or -1, int64 (L,); then those of further parents.
    """
    known = np.zeros(len(parents[0]) + 1, bool)
    known[-1] = True  # no parent
    new = np.unique(rows)
    while len(new) > FEW:
        known[new] = True
        older = np.unique(np.concatenate([each[new] for each in parents]))
        new = older[~known[older]]
    lines = new.tolist()
    while lines:
        if not known[row := lines.pop()]:
            known[row] = True
            lines += [int(each[row]) for each in parents]
    return np.flatnonzero(known[:-1])


def places_of(rising: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return the places of rows, which are all among the rising ones, or -1 of row -1."""
    return np.where(rows < 0, -1, np.searchsorted(rising, rows))


def children(parent_row: np.ndarray) -> np.ndarray:
    """Return the number of children of each organism, int64 (L,)."""
    return np.bincount(parent_row[parent_row >= 0], minlength=len(parent_row))
