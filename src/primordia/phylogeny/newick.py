"""Newick: a phylogeny as text, one tree in each line, for programs that read trees.

The format is https://phylipweb.github.io/phylip/newicktree.html (Felsenstein et al. 1986). A label is
an organism's id. The length of a branch is the number of ticks from the parent's birth to the child's.
The branch of a root has the tick of birth as its length. So the distance from the top of a tree to
an organism is the tick of its birth.
"""

from array import array
from collections.abc import Iterator

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from primordia.history.ancestry import generations
from primordia.phylogeny.phylogeny import Phylogeny
from primordia.phylogeny.table import ROWS, ids


def newick(whole: Phylogeny) -> Iterator[pa.Buffer]:
    """Yield the text of all trees, in pieces; a child's second parent is left out.

    Each organism is written after its children. A parent begins with `)`; an organism without
    children begins with `,` or `(` or both, as needed. Then come label and length.
    """
    lives, parent = whole.lives, whole.lives.parent_row
    order, depth = _children_first(parent), generations(parent)
    since = np.where(parent < 0, 0, lives.born[parent])
    for first in range(0, len(order), ROWS):
        rows = order[first : first + ROWS]
        before = order[
            np.arange(first, first + len(rows)) - 1
        ]  # of the first row: the last, a root
        yield _text(
            _openings(rows, before, parent, depth),
            ids(lives.world[rows], lives.id[rows]),
            (lives.born - since)[rows],
            parent[rows] < 0,
        )


def _children_first(parent: np.ndarray) -> np.ndarray:
    """Return the rows in an order in which each row follows its descendants.

    Parents have lower rows than their children, so two loops over the rows need no recursion.
    """
    count = len(parent)
    parents, size = array("q", parent.tobytes()), array("q", [1]) * count
    for row in range(count - 1, -1, -1):
        if (above := parents[row]) >= 0:
            size[above] += size[row]
    free, top = array("q", bytes(8 * count)), 0
    for row, above in enumerate(parents):
        if above < 0:
            free[row], top = top, top + size[row]
        else:
            free[row] = free[above]
            free[above] += size[row]
    # What is free after the last child of an organism is the organism's own place.
    order = np.empty(count, np.int64)
    order[np.frombuffer(free, np.int64)] = np.arange(count)
    return order


def _openings(
    rows: np.ndarray, before: np.ndarray, parent: np.ndarray, depth: np.ndarray
) -> pa.Array:
    """Return what stands between organisms and those written before them, (n,) texts."""
    closes = parent[before] == rows
    sibling = ~closes & (parent[before] >= 0)
    mark = pa.array(["", ",", ")"]).take(pa.array(sibling + 2 * closes))
    opened = np.where(closes, 0, depth[rows] - np.where(sibling, depth[before], 0))
    return pc.binary_join_element_wise(mark, pc.binary_repeat("(", pa.array(opened)), "")


def _text(openings: pa.Array, label: np.ndarray, ticks: np.ndarray, root: np.ndarray) -> pa.Buffer:
    """Return the text of organisms, one after another."""
    parts = pc.binary_join_element_wise(
        openings,
        pa.array(label).cast(pa.string()),
        ":",
        pa.array(ticks).cast(pa.string()),
        pc.if_else(pa.array(root), ";\n", ""),
        "",
    )
    return parts.buffers()[2]  # Arrow holds texts one after another
