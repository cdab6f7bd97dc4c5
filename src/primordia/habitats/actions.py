"""The kinds of actions that habitats take: choices, amounts, or several of these."""

from dataclasses import dataclass, field
from typing import TypeAlias


@dataclass(frozen=True)
class Discrete:
    """An action is a choice, int32 (N,); `size` is the number of choices."""

    size: int

    @property
    def parts(self) -> "tuple[Discrete]":
        """Return the parts: the action itself is the only one."""
        return (self,)


@dataclass(frozen=True)
class Continuous:
    """An action is a vector: float32 (N, size). The habitat keeps it within bounds."""

    size: int
    bounds: tuple[tuple[float, ...], tuple[float, ...]] | None = field(default=None, compare=False)
    """least and largest numbers, (size,) each; beyond them a number has no further effect; None:
    unknown. Actions that differ in nothing else are equal, since laws with them share compiled code."""

    @property
    def parts(self) -> "tuple[Continuous]":
        """Return the action as its only part."""
        return (self,)


@dataclass(frozen=True)
class Compound:
    """An action has several parts: float32 (N, K), the columns of its parts side by side.

    A discrete part has one column, the number of the choice; a continuous part has `size` columns.
    """

    parts: tuple[Discrete | Continuous, ...]

    @property
    def size(self) -> int:
        """Return the number of outputs that a brain needs."""
        return sum(part.size for part in self.parts)

    @property
    def columns(self) -> int:
        """Return the number K of columns."""
        return sum(1 if isinstance(part, Discrete) else part.size for part in self.parts)


Action: TypeAlias = Discrete | Continuous | Compound
