"""The phylogeny of the living of one world: ancestors, and the times at which lines parted.

An ancestor is a node if it is alive, if two or more lines part at it, or if it has no parent on record.
All other ancestors lie between two nodes. Each node is drawn as a bar on its own level, or on the
level of the last line that left it, so that no two bars cross.
"""

from collections import defaultdict
from typing import Any, NamedTuple

import numpy as np

from primordia.figures.spacetime import line_codes
from primordia.history.ancestry import children, generations, nearest, places_of, with_ancestors
from primordia.report.ground import Ground

LEAVES = 300
"""Largest number of the living that are shown. If more live, an evenly spaced sample is shown."""


class Nodes(NamedTuple):
    """The N nodes of a tree: each is followed by its descendants, those of its youngest branch first."""

    row: np.ndarray
    """row of each node's organism, int64 (N,)"""
    alive: np.ndarray
    """bool (N,)"""
    parent: np.ndarray
    """place of the parent node, or -1, int64 (N,)"""
    left_by: np.ndarray
    """row of a child of the parent node's organism, on the line to this node: the node's organism or
    its ancestor; for a root its own row, int64 (N,)"""
    skipped: np.ndarray
    """number of ancestors between the node and its parent, int64 (N,)"""

    @property
    def level(self) -> np.ndarray:
        """Level of each bar: the number of living nodes before it, int64 (N,)."""
        return np.cumsum(self.alive) - self.alive


def tree(ground: Ground) -> dict[str, Any] | None:
    """Return the phylogeny of the living for `tree.js`; None if nothing is alive.

    Returns:
        `nodes`, parents before their children, each with the birth `number` of its organism; `parent`:
        place among the nodes, or -1; `start`, `stop`: times, in births, at which the node's line
        leaves the parent's line, and at which the bar ends; `level`: from 0, a level for each of
        the living; `ink` of the line; `skipped`: number of ancestors between the node and its parent;
        `island`: its number, if the world has islands.
    """
    lives = ground.lives
    living = np.flatnonzero(~lives.died)
    if not len(living):
        return None
    ordered = living[np.argsort(lives.cell[living], kind="stable")]
    leaves = ordered[:: -(-len(ordered) // LEAVES)]
    nodes = grown(lives.parent_row, leaves)
    now = np.array([lives.ended.max()])
    start = np.searchsorted(lives.born, lives.born[nodes.left_by])
    columns = {
        "number": lives.id[nodes.row],
        "born": lives.born[nodes.row],
        "parent": nodes.parent,
        "start": start,
        # The bar of an ancestor ends where the last line leaves it: that of the next node.
        "stop": np.where(nodes.alive, len(lives), np.append(start[1:], 0)),
        "level": nodes.level,
        "alive": nodes.alive,
        "ink": ground.inks(line_codes(lives, ground.clades, nodes.row[:, None], now)[:, 0]),
        "skipped": nodes.skipped,
    }
    if ground.islands is not None:
        columns["island"] = ground.islands.of_cells(lives.cell[nodes.row])
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return {
        "living": len(living),
        "shown": len(leaves),
        "nodes": [dict(zip(columns, row, strict=True)) for row in rows],
    }


def grown(parent_row: np.ndarray, leaves: np.ndarray) -> Nodes:
    """Return the tree of some organisms, with its roots in order of birth.

    Args:
        parent_row: row of each organism's parent, or -1; int64 (L,), parents before their children.
        leaves: rows of the organisms, int64.
    """
    rows = with_ancestors(leaves, parent_row)
    parent = places_of(rows, parent_row[rows])
    alive = np.isin(rows, leaves)
    is_node = alive | (children(parent) > 1) | (parent < 0)
    own = np.flatnonzero(is_node)
    above = np.append(nearest(parent, own), -1)[parent]
    left_by = nearest(parent, np.flatnonzero((parent < 0) | is_node[parent]))
    below: dict[int, list[int]] = defaultdict(list)
    for node in own[np.argsort(left_by[own])].tolist():
        below[int(above[node])].append(node)
    order, stack = [], below[-1][::-1]
    while stack:
        order.append(stack.pop())
        stack += below[order[-1]]  # the youngest branch is taken first
    place = np.full(len(rows) + 1, -1)  # the last is for no parent
    place[order] = np.arange(len(order))
    depth = np.append(generations(parent), -1)
    skipped = depth[order] - depth[above[order]] - 1
    return Nodes(rows[order], alive[order], place[above[order]], rows[left_by[order]], skipped)
