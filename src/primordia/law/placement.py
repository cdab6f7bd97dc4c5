"""Placement: the cell of each child, and the winner among parents that pick the same cell.

All parents of a tick act at once. Each replicating parent picks a cell. If several pick the same
cell, the parent with the smallest (random bits, cell number) wins. For blind placement this equals
the paper's rule, one parent after another in random order. Cells are numbered within their world,
and a child never leaves its world. Arrays are (W, N): worlds, cells.
"""

import math
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from pydantic import Field

from primordia.random.keys import below, chance
from primordia.random.wide import Wide
from primordia.settings.base import Settings
from primordia.settings.islands import Islands

OFFSETS = {
    "ring": ((0, -1), (0, 1)),
    "torus4": ((0, -1), (0, 1), (-1, 0), (1, 0)),
    "torus8": ((0, -1), (0, 1), (-1, 0), (1, 0), (-1, -1), (-1, 1), (1, -1), (1, 1)),
}

SIDE = np.uint32(2**32 - 1)
"""The number of the round in which it is drawn who is born on another island; no contest has it."""

Draw = Callable[[Array], Wide]
"""A function of a round's number (a tick has several rounds of placement); it returns two random words
for every cell, (W, N)."""


class Placement(Settings):
    """Neighbourhood of a cell, and the rule for picked cells that are occupied.

    blind: no child is born (Schmidgall & Hays 2021, "Evolutionary self-replication", rule c);
    empty-only: parents pick among their empty neighbours, and losers of a contest pick again;
    replacing: the occupant dies (as in Avida). A replaced organism may still copy itself in the tick of
    its death.
    """

    topology: Literal["ring", "torus4", "torus8", "well-mixed"] = Field(
        "ring",
        description="neighbours of a cell: two on a ring, 4 or 8 on a torus, or all "
        "cells of the world",
    )
    rule: Literal["blind", "empty-only", "replacing"] = Field(
        "blind",
        description="what happens if a child's cell is occupied. blind: no birth; empty-only: only "
        "empty cells are picked; replacing: the occupant dies",
    )
    rows: int | None = Field(
        None,
        ge=2,
        description="number of rows of a torus (default: the torus is as nearly square as possible)",
    )

    migration: float = Field(
        0.0,
        ge=0,
        le=1,
        description="probability that a child is born on another island, if neighbours are all cells"
        " of an island; may differ by island and change with seasons",
    )

    def together(self, cells: int) -> int:
        """Return the number of cells that no border of islands divides; `cells` is a world's size."""
        rows, columns = self.shape(cells)
        return 1 if rows == 1 else columns

    def shape(self, cells: int) -> tuple[int, int]:
        """Return a world's rows and columns; `cells` is its size.

        Raises:
            ValueError: the cells do not make a torus with two or more rows and columns.
        """
        if not self.topology.startswith("torus"):
            return 1, cells
        if self.rows is not None:
            rows = self.rows if cells % self.rows == 0 else 1
        else:
            rows = max(r for r in range(1, math.isqrt(cells) + 1) if cells % r == 0)
        if rows < 2 or cells // rows < 2:
            raise ValueError(
                f"{cells} cells do not make a torus; let cells be rows x columns, both 2 or more"
            )
        return rows, cells // rows

    def room(self, occupied: Array) -> Array:
        """Return which cells have a neighbour in which a birth is allowed, bool (W, N)."""
        if self.rule == "replacing":
            return jnp.ones_like(occupied)
        if self.topology == "well-mixed":
            return jnp.broadcast_to(~occupied.all(axis=1, keepdims=True), occupied.shape)
        return jnp.stack(self._neighbours(~occupied)).any(axis=0)

    def near(self, cells: Array, islands: Islands) -> Array:
        """Return the neighbours of K cells as a mask over the N cells of a world, bool (K, N)."""
        count = islands.bounds[-1]
        every = jnp.arange(count)
        if self.topology == "well-mixed":
            first, size = _stretch(islands, cells[:, None])
            return (every != cells[:, None]) & (every >= first) & (every < first + size)
        offsets = np.array(OFFSETS[self.topology], np.int32)
        directions = jnp.broadcast_to(jnp.arange(len(offsets)), (len(cells), len(offsets)))
        numbered = jnp.broadcast_to(cells[:, None], directions.shape)
        around = self._neighbour(numbered, directions, offsets, count)
        return (around[:, :, None] == every).any(axis=1)

    def parents(
        self,
        draw: Draw,
        wants: Array,
        occupied: Array,
        islands: Islands | None = None,
        migration: Array | None = None,
    ) -> Array:
        """Return, for each cell, the cell of its newborn's parent, or -1: int32 (W, N).

        Args:
            draw: the random words of the tick.
            wants: organisms that replicate if they find a cell, bool (W, N).
            occupied: cells that were occupied before the tick, bool (W, N).
            islands: the islands of a world; None: a plain world.
            migration: probability that a child of a cell is born on another island, float32 (W, N).
                On a ring or torus children cross borders next door instead.
        """
        reach = None
        if islands is not None and migration is not None and self.topology == "well-mixed":
            leaves = chance(draw(jnp.asarray(SIDE)).hi, migration)
            reach = Reach(*_stretch(islands, _cells(wants)), leaves)
        if self.rule == "empty-only":
            return self._in_rounds(draw, wants, occupied, reach)
        choice, priority = draw(jnp.uint32(0))
        target = self._any_target(choice, reach)
        if self.rule == "blind":
            wants = wants & ~jnp.take_along_axis(occupied, target, axis=1)
        return _contest(wants, target, priority)

    def _in_rounds(self, draw: Draw, wants: Array, occupied: Array, reach: "Reach | None") -> Array:
        """Hold contests until no parent that still wants a child has an empty neighbour."""

        def candidates(wants: Array, occupied: Array) -> Array:
            if reach is not None:
                return wants & (reach.empty(~occupied)[1] > 0)
            return wants & self.room(occupied)

        def unfinished(carry: Any) -> Array:
            _, wants, occupied, _ = carry
            return candidates(wants, occupied).any()

        def hold_round(carry: Any) -> Any:
            number, wants, occupied, parent = carry
            choice, priority = draw(number)
            target = self._empty_target(choice, ~occupied, reach)
            winner = _contest(candidates(wants, occupied), target, priority)
            has_won = jnp.take_along_axis(winner, target, axis=1) == _cells(wants)
            parent = jnp.maximum(parent, winner)
            return number + 1, wants & ~has_won, occupied | (winner >= 0), parent

        no_parent = jnp.full(wants.shape, -1, jnp.int32)
        carry = (jnp.uint32(0), wants, occupied, no_parent)
        return lax.while_loop(unfinished, hold_round, carry)[3]

    def _any_target(self, word: Array, reach: "Reach | None") -> Array:
        """Return a random neighbour of each cell, all equally likely: int32 (W, N)."""
        cells = _cells(word)
        if reach is not None:
            return reach.any_target(word, cells)
        if self.topology == "well-mixed":
            drawn = below(word, word.shape[1] - 1)
            return drawn + (drawn >= cells)  # skip the cell itself
        offsets = np.array(OFFSETS[self.topology], np.int32)
        return self._neighbour(cells, below(word, len(offsets)), offsets, word.shape[1])

    def _empty_target(self, word: Array, empty: Array, reach: "Reach | None") -> Array:
        """Return a random empty neighbour of each cell, all equally likely: int32 (W, N).

        The result is an arbitrary cell if there is no empty neighbour.
        """
        cells = _cells(word)
        if self.topology == "well-mixed":
            rank = jnp.where(empty, jnp.cumsum(empty, axis=1) - 1, word.shape[1])
            worlds = jnp.arange(len(word))[:, None]
            listed = jnp.zeros_like(cells).at[worlds, rank].set(cells, mode="drop")
            if reach is not None:
                before, count = reach.empty(empty)
                nth = reach.skipping(below(word, count), before, empty)
            else:
                nth = below(word, empty.sum(axis=1, keepdims=True))
            return jnp.take_along_axis(listed, nth, axis=1)
        offsets = np.array(OFFSETS[self.topology], np.int32)
        is_empty = jnp.stack(self._neighbours(empty))
        nth = below(word, is_empty.sum(axis=0))
        chosen = (jnp.cumsum(is_empty, axis=0) > nth).argmax(axis=0)
        return self._neighbour(cells, chosen, offsets, word.shape[1])

    def _neighbour(self, cells: Array, direction: Array, offsets: np.ndarray, count: int) -> Array:
        rows, columns = self.shape(count)
        step = jnp.asarray(offsets)[direction]
        row, column = cells // columns + step[..., 0], cells % columns + step[..., 1]
        return row % rows * columns + column % columns

    def _neighbours(self, values: Array) -> list[Array]:
        """Return the values (W, N) of each cell's neighbours, an array for each direction."""
        grid = values.reshape(len(values), *self.shape(values.shape[1]))
        offsets = OFFSETS[self.topology]
        return [jnp.roll(grid, (-r, -c), (1, 2)).reshape(values.shape) for r, c in offsets]


class Reach(NamedTuple):
    """The cells in which children of each cell may be born, well-mixed on islands, (W, N)."""

    first: Array
    """first cell of the parent's island, int32"""
    size: Array
    """cells of the parent's island, int32"""
    leaves: Array
    """whether the child is born on another island, bool"""

    def any_target(self, word: Array, cells: Array) -> Array:
        """Return a random cell for each child, all equally likely, but not the parent's: int32."""
        home = self.first + below(word, self.size - 1)
        home = home + (home >= cells)
        away = below(word, cells.shape[1] - self.size)
        return jnp.where(self.leaves, away + (away >= self.first) * self.size, home)

    def empty(self, empty: Array) -> tuple[Array, Array]:
        """Return the numbers of empty cells before the parent's island and within reach, int32 (W, N)."""
        upto = jnp.pad(jnp.cumsum(empty, axis=1, dtype=jnp.int32), ((0, 0), (1, 0)))
        before, after = (
            jnp.take_along_axis(upto, place, axis=1)
            for place in (self.first, self.first + self.size)
        )
        home = after - before
        return before, jnp.where(self.leaves, upto[:, -1:] - home, home)

    def skipping(self, nth: Array, before: Array, empty: Array) -> Array:
        """Return which of a world's empty cells is the nth within reach, int32 (W, N).

        `before` is that of the method `empty`.
        """
        home = empty.sum(axis=1, keepdims=True, dtype=jnp.int32) - self.empty(empty)[1]
        return jnp.where(self.leaves, nth + (nth >= before) * home, before + nth)


def _stretch(islands: Islands, cells: Array) -> tuple[Array, Array]:
    """Return the first cell and the size of the island of each cell, int32."""
    bounds = np.array(islands.bounds, np.int32)
    island = (cells[..., None] >= bounds[1:-1]).sum(axis=-1)
    return jnp.asarray(bounds[:-1])[island], jnp.asarray(np.diff(bounds))[island]


def _cells(like: Array) -> Array:
    return lax.broadcasted_iota(jnp.int32, like.shape, 1)


def _contest(wants: Array, target: Array, priority: Array) -> Array:
    """Return the parent that wins each cell, or -1. The contestant with the smallest priority wins,
    and among equal ones the smallest cell."""
    worlds, cells = wants.shape
    nowhere = worlds * cells
    slot = target + cells * lax.broadcasted_iota(jnp.int32, wants.shape, 0)
    slot = jnp.where(wants, slot, nowhere).ravel()
    priority = priority.ravel()
    best = jnp.full(nowhere, np.uint32(2**32 - 1)).at[slot].min(priority, mode="drop")
    ahead = priority == best.at[slot].get(mode="fill", fill_value=0)
    first = jnp.full(nowhere, cells, jnp.int32)
    first = first.at[jnp.where(ahead, slot, nowhere)].min(_cells(wants).ravel(), mode="drop")
    return jnp.where(first < cells, first, -1).reshape(worlds, cells)
