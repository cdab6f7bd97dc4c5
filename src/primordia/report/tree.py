"""The phylogeny of the living of one world: ancestors, and the times at which lines parted.

An ancestor is a node if it is alive, if two or more lines part at it, or if it has no parent on record.
All other ancestors lie between two nodes. Each node is drawn as a bar on its own level, or on the
level of the last line that left it, so that no two bars cross.
"""

import heapq
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from primordia.figures.spacetime import line_codes
from primordia.report.ground import Ground

LEAVES = 300
"""Largest number of the living that are shown. If more live, an evenly spaced sample is shown."""


@dataclass
class Node:
    """One node of the tree; organisms are given by row."""

    row: int
    alive: bool
    left_by: int
    """a child of the parent node's organism, on the line to this node: the node's organism or its
    ancestor"""
    skipped: int = 0
    """number of ancestors between the node and its parent"""
    parent: "Node | None" = None
    children: "list[Node]" = field(default_factory=list)
    """child nodes by birth of `left_by`, the latest first"""
    level: int = 0


def tree(ground: Ground) -> dict[str, Any] | None:
    """Return the phylogeny of the living for `tree.js`; None if nothing is alive.

    Returns:
        `nodes`, parents before their children, each with the birth `number` of its organism; `parent`:
        place among the nodes, or -1; `start`, `stop`: times, in births, at which the node's line
        leaves the parent's line, and at which the bar ends; `level`: from 0, a level for each of
        the living; `ink` of the line; `skipped`: number of ancestors between the node and its parent.
    """
    lives = ground.lives
    living = np.flatnonzero(~lives.died)
    if not len(living):
        return None
    ordered = living[np.argsort(lives.cell[living], kind="stable")]
    leaves = ordered[:: -(-len(ordered) // LEAVES)].tolist()
    nodes = in_order(grown(lives.parent_row, leaves))
    rows = np.array([node.row for node in nodes])
    now = np.array([lives.ended.max()])
    inks = ground.inks(line_codes(lives, ground.clades, rows[:, None], now)[:, 0]).tolist()
    start = np.searchsorted(lives.born, lives.born[[node.left_by for node in nodes]]).tolist()
    begun = {node.row: place for node, place in zip(nodes, start, strict=True)}
    place_of = {node.row: place for place, node in enumerate(nodes)}
    return {
        "living": len(living),
        "shown": len(leaves),
        "nodes": [
            {
                "number": int(lives.id[node.row]),
                "born": int(lives.born[node.row]),
                "parent": -1 if node.parent is None else place_of[node.parent.row],
                "start": begun[node.row],
                "stop": len(lives) if node.alive else begun[node.children[0].row],
                "level": node.level,
                "alive": node.alive,
                "ink": ink,
                "skipped": node.skipped,
            }
            for node, ink in zip(nodes, inks, strict=True)
        ],
    }


def grown(parent_row: np.ndarray, leaves: list[int]) -> list[Node]:
    """Return the roots of the tree of some organisms, in order of birth.

    Args:
        parent_row: row of each organism's parent, or -1; int64 (L,), parents before their children.
        leaves: rows of the organisms.
    """
    alive, roots = set(leaves), []
    branches: dict[int, list[Node]] = {row: [] for row in leaves}
    youngest_first = [-row for row in leaves]
    heapq.heapify(youngest_first)
    while youngest_first:
        row = -heapq.heappop(youngest_first)
        above, parent = branches.pop(row), int(parent_row[row])
        if row in alive or len(above) > 1 or parent < 0:
            node = Node(row, row in alive, row, children=above)
            for child in above:
                child.parent = node
        else:
            (node,) = above
            node.left_by, node.skipped = row, node.skipped + 1
        if parent < 0:
            roots.append(node)
        elif parent in branches:
            branches[parent].append(node)
        else:
            branches[parent] = [node]
            heapq.heappush(youngest_first, -parent)
    return roots[::-1]


def in_order(roots: list[Node]) -> list[Node]:
    """Return all nodes, parents before their children, and give each its level."""
    ordered, stack, level = [], roots[::-1], 0
    while stack:
        node = stack.pop()
        ordered.append(node)
        if node.alive:
            node.level, level = level, level + 1
        stack += node.children[::-1]
    for node in reversed(ordered):
        if not node.alive:
            node.level = node.children[0].level
    return ordered
