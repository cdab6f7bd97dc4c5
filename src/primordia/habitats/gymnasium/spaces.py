"""Spaces of Gymnasium as numbers: observations become a row, and rows of actions become actions.

Dict and Tuple spaces are walked in their own order, so a row holds their parts one after the other.
A row of an observation holds one number for a Discrete part, and all numbers of any other part.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from gymnasium.spaces import Box, MultiBinary, MultiDiscrete, Space

from primordia.habitats.contract import Action, Compound, Continuous, Discrete

UNBOUNDED = 1e6
"""A bound of a box at or beyond this number counts as no bound."""


Builder = Callable[[np.ndarray], Any]
Block = tuple[slice, int | None]
"""A block of numbers that are one sense each, or a single number that is one of n choices."""


class Leaf(NamedTuple):
    """A part of a space that holds numbers, and the keys that lead to it."""

    space: Space
    path: tuple[Any, ...] = ()

    @property
    def width(self) -> int:
        """The count of numbers of this part in a row."""
        if isinstance(self.space, spaces.Discrete):
            return 1
        return int(np.prod(self.space.shape or ()))

    @property
    def first(self) -> Any:
        """The space's number for its first choice, which a row stores as 0. For other parts, 0."""
        return self.space.start if isinstance(self.space, spaces.Discrete | MultiDiscrete) else 0


def leaves(space: Space, what: str, path: tuple[Any, ...] = ()) -> Iterator[Leaf]:
    """Yield the parts of a space that hold numbers; `what` names the space in messages.

    Raises:
        ValueError: a part has no fixed count of numbers; the message says which.
    """
    if isinstance(space, spaces.Dict):
        for key, inner in space.spaces.items():
            yield from leaves(inner, what, (*path, key))
    elif isinstance(space, spaces.Tuple):
        for number, inner in enumerate(space.spaces):
            yield from leaves(inner, what, (*path, number))
    elif isinstance(space, Box | spaces.Discrete | MultiDiscrete | MultiBinary):
        yield Leaf(space, path)
    else:
        place = "".join(f"[{key!r}]" for key in path)
        raise ValueError(
            f"its {what} space{place} is a {type(space).__name__}, which has no fixed number of"
            " values; wrap the environment so that it is a Box, Discrete, MultiDiscrete,"
            " MultiBinary, or a Dict or Tuple of these"
        )


class Observation:
    """The conversion of observations to rows, and of rows to senses."""

    def __init__(self, space: Space) -> None:
        """Raise ValueError if the space cannot be perceived."""
        self._leaves = list(leaves(space, "observation"))
        self._slices = _slices(self._leaves)
        self._is_vector = isinstance(space, Box) and len(space.shape) == 1
        self.width = sum(leaf.width for leaf in self._leaves)
        kinds = [leaf.space.dtype or np.dtype(np.int64) for leaf in self._leaves]
        exact = np.result_type(np.float32, *kinds) == np.float32
        self.dtype = "float32" if exact else "float64"
        """dtype of a row: float32 if it holds all values exactly"""
        if not self.width:
            raise ValueError("its observation space is empty, so organisms would have no senses")

    def fill(self, row: np.ndarray, observation: Any) -> None:
        """Write an observation into a row (R,)."""
        if self._is_vector:
            row[:] = observation
            return
        for leaf, own in zip(self._leaves, self._slices, strict=True):
            value = observation
            for key in leaf.path:
                value = value[key]
            row[own] = (np.asarray(value) - leaf.first).reshape(-1)

    def unbounded(self) -> np.ndarray:
        """Return which numbers of a row are unbounded, bool (R,)."""
        return ~np.isfinite(_bounds(self._leaves, (0, 1))).all(axis=0)

    def senses(self, scale: np.ndarray, squash: bool) -> "Senses":
        """Return the conversion of rows to senses; see `Senses`."""
        low, high = _bounds(self._leaves, (0, 1))
        bounded = np.isfinite(low) & np.isfinite(high) & (high > low)
        low, high = np.where(bounded, low, -scale), np.where(bounded, high, scale)
        blocks: list[Block] = []
        for leaf, own in zip(self._leaves, self._slices, strict=True):
            blocks += [(own, None)] if isinstance(leaf.space, Box) else _choices(leaf, own)
        return Senses((low + high) / 2, (high - low) / 2, squash & ~bounded, blocks)


class Senses:
    """The senses of rows of observations.

    A number x of a box from a to b becomes 2 (x - a) / (b - a) - 1. An unbounded number is divided
    by its scale s; with `squash`, x / s becomes (x / s) / (1 + |x / s|). One of n choices becomes n
    senses: 1 for the choice and 0 for the others. A binary number becomes -1 or 1.
    """

    def __init__(
        self, middle: np.ndarray, half: np.ndarray, squashed: np.ndarray, blocks: "list[Block]"
    ) -> None:
        self._middle, self._half, self._squashed, self._blocks = middle, half, squashed, blocks
        self.size = sum(n or own.stop - own.start for own, n in blocks)
        self._plain = len(blocks) == 1 and blocks[0][1] is None

    def __call__(self, rows: np.ndarray) -> np.ndarray:
        """Return the senses (N, S), float32, of rows (N, R)."""
        scaled = (rows - self._middle) / self._half
        if self._squashed.any():
            small = scaled / (1 + np.abs(scaled))
            scaled = np.where(self._squashed, small, scaled)
        if self._plain:
            return scaled.astype(np.float32)
        parts = [
            scaled[:, own] if n is None else rows[:, own] == np.arange(n) for own, n in self._blocks
        ]
        return np.concatenate(parts, axis=1, dtype=np.float32)


class Acting:
    """The conversion of the law's actions to the environment's."""

    def __init__(self, space: Space) -> None:
        """Raise ValueError if the environment cannot be acted upon."""
        self._leaves = list(leaves(space, "action"))
        self._parts = [part for leaf in self._leaves for part in _motors(leaf)]
        single = [part for part in self._parts if part.size > isinstance(part, Discrete)]
        if not single:
            raise ValueError("its action space has no choice, so a brain could do nothing")
        if len(single) < len(self._parts):
            raise ValueError("a part of its action space has a single choice; wrap the environment")
        self.kind: Action = single[0] if len(single) == 1 else Compound(tuple(single))
        self.columns = 1 if isinstance(self.kind, Discrete) else _columns(self.kind)
        self._low, self._high = bounds = _bounds(self._leaves, (-np.inf, np.inf))
        self._bounded = np.isfinite(bounds).all(axis=0)
        low, high = np.where(self._bounded, bounds, [[-1], [1]])
        self._middle, self._half = (low + high) / 2, (high - low) / 2
        own = zip((leaf.path for leaf in self._leaves), _slices(self._leaves), strict=True)
        self.build = _builder(space, dict(own))
        """a function of a row (K,) that returns the environment's action"""

    def rows(self, action: np.ndarray) -> np.ndarray:
        """Return the law's actions, int32 (N,) or float32 (N, K), as rows, float64 (N, K).

        Outputs from -1 to 1 cover the range of a number with bounds. Choices and unbounded
        numbers are unchanged.
        """
        values = np.asarray(action, float).reshape(len(action), -1)
        inside = np.where(self._bounded, np.clip(values, -1, 1), values)
        return np.clip(self._middle + self._half * inside, self._low, self._high)


def _bounds(parts: list[Leaf], of_choices: tuple[float, float]) -> np.ndarray:
    """Return the least and largest value of each number of parts, infinite without a bound: (2, K).

    `of_choices` are those of a number that is not part of a Box.
    """
    rows = []
    for leaf in parts:
        space = leaf.space
        both = (space.low, space.high) if isinstance(space, Box) else of_choices
        rows.append([np.broadcast_to(each, space.shape or (leaf.width,)).ravel() for each in both])
    bounds = np.concatenate(rows, axis=1, dtype=float)
    return np.where(np.abs(bounds) < UNBOUNDED, bounds, np.copysign(np.inf, bounds))


def _slices(parts: list[Leaf]) -> list[slice]:
    ends = np.cumsum([leaf.width for leaf in parts]).tolist()
    return [slice(end - leaf.width, end) for leaf, end in zip(parts, ends, strict=True)]


def _sizes(leaf: Leaf) -> list[int]:
    """Return the number of choices of each number of a part that is not a Box."""
    space = leaf.space
    if isinstance(space, spaces.Discrete):
        return [int(space.n)]
    return np.ravel(space.nvec).tolist() if isinstance(space, MultiDiscrete) else [2] * leaf.width


def _choices(leaf: Leaf, own: slice) -> "list[Block]":
    """Return the blocks of senses of a part that is not a Box; a binary number is one sense."""
    blocks: list[Block] = []
    for place, size in enumerate(_sizes(leaf), own.start):
        one = slice(place, place + 1)
        blocks.append((one, None) if isinstance(leaf.space, MultiBinary) else (one, size))
    return blocks


def _motors(leaf: Leaf) -> list[Discrete | Continuous]:
    if isinstance(leaf.space, Box):
        return [Continuous(leaf.width)]
    return [Discrete(size) for size in _sizes(leaf)]


def _columns(kind: Action) -> int:
    return kind.columns if isinstance(kind, Compound) else kind.size


def _builder(
    space: Space, own: dict[tuple[Any, ...], slice], path: tuple[Any, ...] = ()
) -> Builder:
    """Return a function that builds an action of a space from a row; `own` are the parts' columns."""
    if isinstance(space, spaces.Dict):
        named = {key: _builder(each, own, (*path, key)) for key, each in space.spaces.items()}
        return lambda row: {key: build(row) for key, build in named.items()}
    if isinstance(space, spaces.Tuple):
        listed = [_builder(each, own, (*path, n)) for n, each in enumerate(space.spaces)]
        return lambda row: tuple(build(row) for build in listed)
    columns, shape, dtype = own[path], space.shape, space.dtype
    if isinstance(space, spaces.Discrete):
        column, start = columns.start, int(space.start)
        return lambda row: int(row[column]) + start
    first = space.start if isinstance(space, MultiDiscrete) else 0
    if np.issubdtype(dtype, np.integer):
        return lambda row: (np.rint(row[columns]).reshape(shape) + first).astype(dtype)
    return lambda row: row[columns].reshape(shape).astype(dtype)


def described(space: Space) -> str:
    """Return a space in one line."""
    if isinstance(space, Box):
        return (
            f"Box {space.shape} of {space.dtype}, from {space.low.min():g} to {space.high.max():g}"
        )
    return " ".join(str(space).split())
