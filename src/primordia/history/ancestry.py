"""Ancestors and children in one world, for all of its organisms at once."""

import numpy as np

ROWS = 4096
"""Number of organisms in one step."""
FEW = 8
"""Largest number of lines that Python follows one by one; with more lines, NumPy is faster."""


def nearest(parent_row: np.ndarray, marked: np.ndarray) -> np.ndarray:
    """Return the row of the nearest marked organism on each organism's line of descent, or -1.

    For a marked organism it is the organism itself.

    Args:
        parent_row: row of each parent, or -1, int64 (L,), parents before their children.
        marked: rows, int64.
    """
    found = np.full(len(parent_row) + 1, -1)  # the last is for no parent, -1
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
    """Return the rows of some organisms and all their ancestors, in ascending order, int64.

    Args:
        rows: rows of the organisms, int64.
        parents: rows of all first parents, or -1, int64 (L,); then rows of further parents.
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
    """Return the place of each row in the sorted array `rising`, which has all rows; -1 for row -1."""
    return np.where(rows < 0, -1, np.searchsorted(rising, rows))


def children(parent_row: np.ndarray) -> np.ndarray:
    """Return the number of children of each organism, int64 (L,)."""
    return np.bincount(parent_row[parent_row >= 0], minlength=len(parent_row))


def generations(parent_row: np.ndarray) -> np.ndarray:
    """Return the number of ancestors on record of each organism, int64 (L,)."""
    return along(parent_row, parent_row >= 0)


def along(parent_row: np.ndarray, counted: np.ndarray) -> np.ndarray:
    """Count the organisms on the line of descent of each organism, itself included, int64 (L,).

    Each step doubles the distance up to which ancestors are counted, so few steps are needed
    (pointer jumping: Wyllie 1979).

    Args:
        parent_row: row of each parent, or -1, int64 (L,).
        counted: the organisms that count, bool (L,), all with a parent.
    """
    far = np.where(parent_row >= 0, parent_row, np.arange(len(parent_row)))
    number = counted.astype(np.int64)
    while True:
        further = far[far]
        if np.array_equal(further, far):
            return number
        number, far = number + number[far], further
