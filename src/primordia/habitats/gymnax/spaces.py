"""Spaces of environments: a brain's outputs become actions, and observations become senses."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.habitats.contract import Continuous, Discrete

BOUNDED = 1e6
"""A number with a bound of this size or more, such as the largest float, counts as unbounded."""


class Actions:
    """The actions of a space: one of n choices, or numbers within bounds."""

    def __init__(self, space: Any, env: str) -> None:
        """Raise ValueError if the space is of neither kind."""
        self.kind: Discrete | Continuous
        self._shape: tuple[int, ...] = ()
        if isinstance(count := getattr(space, "n", None), int) and count > 1:
            self.kind = Discrete(count)
            return
        low, high = (getattr(space, name, None) for name in ("low", "high"))
        if low is None or high is None:
            raise ValueError(
                f"env: the actions of {env} are {space!r}; a brain needs two or more choices, or"
                " the numbers of a box"
            )
        self._shape = tuple(space.shape)
        self.kind = Continuous(int(np.prod(self._shape)))
        self._bounded, middle, half = _bounds(low, high, self._shape)
        self._middle = np.where(self._bounded, middle, 0).astype(np.float32)
        self._half = np.where(self._bounded, half, 1).astype(np.float32)

    def of(self, output: Array) -> Array:
        """Return the action of one body for an output of a brain: int32 (), or float32 (size,).

        Outputs -1 and 1 give the lower and upper bound of a number; an unbounded number is
        unchanged.
        """
        if isinstance(self.kind, Discrete):
            return output
        kept = jnp.where(self._bounded, jnp.clip(output, -1, 1), output)
        return (kept * self._half + self._middle).reshape(self._shape)


class Senses:
    """Observations as flat float32 senses; a number with a bound beyond -1 or 1 is scaled to [-1, 1]."""

    def __init__(
        self,
        space: Any,
        example: Any,
        squash: bool,
        centre: int | None = None,
        sight: int | None = None,
    ) -> None:
        """Use the space, or None, and an observation's shapes and types.

        Raises:
            ValueError: there is a `centre`, and the observation is not a grid with this channel.
        """
        self._choices = count if isinstance(count := getattr(space, "n", None), int) else 0
        self._squash = squash
        leaves = jax.tree.leaves(example)
        self.size = self._choices or sum(int(np.prod(leaf.shape)) for leaf in leaves)
        self.grid = _grid(leaves[0].shape) if len(leaves) == 1 else None
        """(height, width, channels) of senses that are a grid"""
        low, high = (getattr(space, name, None) for name in ("low", "high"))
        if low is None or high is None or len(leaves) != 1:
            low, high = -np.inf, np.inf
        if self._choices:
            low, high = 0, self._choices - 1
        self._low, self._high = (np.float32(each).ravel() for each in (low, high))
        bounded, middle, half = _bounds(low, high, leaves[0].shape)
        self.view = View(self.grid, centre, sight) if centre is not None else None
        """what is perceived around the player of a grid; None: the whole observation"""
        if self.view:
            self.grid = self.view.shape
            self.size = int(np.prod(self.grid))
        self._unbounded = ~bounded
        scaled = bounded & (np.abs(middle) + half > 1) & (half > 0)
        self._middle = np.where(scaled, middle, 0).astype(np.float32)
        self._scale = np.where(scaled, 1 / np.where(scaled, half, 1), 1).astype(np.float32)

    def of(self, observation: Any) -> Array:
        """Return the senses of one body, float32 (size,).

        One of n choices becomes n numbers: 1 for the choice, 0 for the others. An unbounded number
        x stays x, or becomes x / (1 + |x|) with `squash`.
        """
        flat = flattened(observation)
        if self._choices:
            return (jnp.arange(self._choices) == flat[0]).astype(jnp.float32)
        if (self._scale != 1).any() or self._middle.any():
            flat = (flat - self._middle) * self._scale
        if self._squash:
            flat = jnp.where(self._unbounded, flat / (1 + jnp.abs(flat)), flat)
        return self.view.of(flat) if self.view else flat

    def declared(self, observed: Array) -> Array:
        """Return whether observations, float32 (N, S), are in their space, bool (N,)."""
        outside = (observed < self._low) | (observed > self._high)
        return ~outside.any(axis=1)

    def unbounded(self) -> np.ndarray:
        """Return which numbers of an observation have no bounds, bool (S,)."""
        return self._unbounded


class View:
    """What lies around the player of a grid, whose place is the largest number of one channel.

    In what is perceived this channel has 1 where the grid ends, and 0 within the grid.
    """

    def __init__(self, grid: tuple[int, ...] | None, centre: int, sight: int | None) -> None:
        """Take the grid's (height, width, channels), the player's channel, and the number of cells seen
        in each direction; None: all.

        Raises:
            ValueError: there is no grid, or it has no such channel.
        """
        if grid is None or not 0 <= centre < grid[2]:
            raise ValueError(f"centre: the observations are no grid with a channel {centre}")
        self.grid, self._centre = grid, centre
        self.sight = max(grid[:2]) - 1 if sight is None else sight
        self.shape = (*[2 * self.sight + 1] * 2, grid[2])

    def place(self, grid: Array) -> tuple[Array, Array]:
        """Return the player's row and column in a grid (height, width, channels)."""
        return divmod(jnp.argmax(grid[..., self._centre]), self.grid[1])

    def of(self, flat: Array) -> Array:
        """Return the senses of one body, float32 (size,), from all numbers of its grid."""
        grid = flat.reshape(self.grid)
        row, column = self.place(grid)
        wide = [(self.sight, self.sight)] * 2
        around = jnp.pad(grid, [*wide, (0, 0)])
        outside = jnp.pad(jnp.zeros(self.grid[:2], flat.dtype), wide, constant_values=1)
        around = around.at[..., self._centre].set(outside)
        return lax.dynamic_slice(around, (row, column, 0), self.shape).ravel()


def flattened(observation: Any) -> Array:
    """Return all numbers of an observation as float32 (size,)."""
    leaves = [
        jnp.asarray(leaf).astype(jnp.float32).ravel() for leaf in jax.tree.leaves(observation)
    ]
    return leaves[0] if len(leaves) == 1 else jnp.concatenate(leaves)


def _grid(shape: tuple[int, ...]) -> tuple[int, ...] | None:
    """Return the (height, width, channels) of an observation of this shape; None if it is not a grid."""
    return (*shape, 1)[:3] if len(shape) in (2, 3) else None


def _bounds(low: Any, high: Any, shape: tuple[int, ...]) -> tuple[np.ndarray, ...]:
    """Return which numbers of a box have bounds, and the middle and half the width of each, (size,)."""
    low, high = (
        np.broadcast_to(np.asarray(each, np.float64), shape).ravel() for each in (low, high)
    )
    bounded = (np.abs(low) < BOUNDED) & (np.abs(high) < BOUNDED)
    low, high = np.where(bounded, low, 0), np.where(bounded, high, 0)
    return bounded, (low + high) / 2, (high - low) / 2
