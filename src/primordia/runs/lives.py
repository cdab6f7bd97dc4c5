"""Everyone who ever lived in a run, one row each: births and deaths joined."""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
import pyarrow as pa

from primordia.errors import InputError
from primordia.law.world import BirthCause, Cause, Named

ALIVE = -1
"""In place of a cause of death."""


@dataclass(frozen=True)
class Lives:
    """Arrays (L,), in order of (world, birth number). The living are censored at their world's end."""

    world: np.ndarray
    """int32"""
    id: np.ndarray
    """int64, birth number within the world"""
    parent: np.ndarray
    """int64, or -1: from nothing"""
    cell: np.ndarray
    """int32"""
    birth_cause: np.ndarray
    """int8, an `BirthCause`"""
    born: np.ndarray
    """int64, tick"""
    seen: np.ndarray
    """int64, tick from which on it is on record: its birth, or the fork at which it was alive"""
    ended: np.ndarray
    """int64, tick of death, or the world's last so far"""
    cause: np.ndarray
    """int8, a `Cause` of death, or ALIVE"""

    def __len__(self) -> int:
        return len(self.id)

    @property
    def lifespan(self) -> np.ndarray:
        """Ticks lived, so far or in all, int64 (L,)."""
        return self.ended - self.born

    @property
    def entered(self) -> np.ndarray:
        """Age from which on it is on record, int64 (L,): 0, but for those alive at a fork.

        Of their generation only those who lived so long are on record, so they tell nothing of younger
        ages.
        """
        return self.seen - self.born

    @property
    def rank(self) -> np.ndarray:
        """Place in its world's order of birth, from 0, int64 (L,).

        That is the birth number, but not in a fork, whose records leave out who had died before it.
        """
        return np.arange(len(self)) - np.searchsorted(self.world, self.world)

    @property
    def died(self) -> np.ndarray:
        """Who is not alive, bool (L,)."""
        return self.cause != ALIVE

    @property
    def worlds(self) -> int:
        """How many worlds have lives in them."""
        return int(self.world[-1]) + 1 if len(self) else 0

    def of_world(self, world: int) -> "Lives":
        """Those of one world."""
        return self.take(self._rows_of_world(world))

    def since(self, tick: int) -> "Lives":
        """As they would be on record had that begun at the end of a tick."""
        later = self.take(np.flatnonzero(~self.died | (self.ended > tick)))
        return replace(later, seen=np.maximum(later.seen, tick))

    def until(self, tick: int) -> "Lives":
        """As they would be on record had that stopped at the end of a tick."""
        before = self.take(np.flatnonzero(self.born <= tick))
        late = before.ended > tick
        return replace(
            before,
            ended=np.where(late, tick, before.ended),
            cause=np.where(late, np.int8(ALIVE), before.cause),
        )

    def since_fork(self) -> "Lives":
        """With time counted from where a fork began; those alive at it were born before."""
        inherited = self.entered > 0
        then = int(self.seen[inherited].min()) if inherited.any() else 0
        return replace(self, born=self.born - then, seen=self.seen - then, ended=self.ended - then)

    def oldest(self, world: int | None = None) -> int:
        """Row of the longest life, in one world or in all, of equals the first.

        Raises:
            InputError: nothing has lived there.
        """
        here = self._rows_of_world(world) if world is not None else slice(0, len(self))
        if here.start == here.stop:
            raise InputError(f"there is no world {world}; they count from 0 to {self.worlds - 1}")
        return here.start + int(np.argmax(self.ended[here] - self.born[here]))

    def row(self, organism: int, world: int = 0) -> int:
        """Where an organism stands.

        Raises:
            InputError: no such organism was born.
        """
        here = self._rows_of_world(world)
        row = here.start + int(np.searchsorted(self.id[here], organism))
        if row == here.stop or self.id[row] != organism:
            raise InputError(f"no organism {organism} was born in world {world}")
        return row

    def take(self, rows: slice | np.ndarray) -> "Lives":
        """Those in the given rows."""
        return Lives(**{each.name: getattr(self, each.name)[rows] for each in fields(self)})

    @cached_property
    def parent_row(self) -> np.ndarray:
        """Row of each one's parent, int64 (L,), or -1 where it is not among these."""
        return _rows(self.world, self.id, self.world, self.parent)

    def rows_in(self, worlds: np.ndarray, numbers: np.ndarray) -> np.ndarray:
        """Return the row of each of these lives among births sorted by world and number, int64 (L,)."""
        return _rows(worlds, numbers, self.world, self.id)

    def _rows_of_world(self, world: int) -> slice:
        first, last = np.searchsorted(self.world, [world, world + 1])
        return slice(int(first), int(last))


def joined(
    births: Iterable[pa.Table], deaths: Iterable[pa.Table], ends: np.ndarray, begins: int
) -> Lives:
    """Return the lives that a run's tables tell of; segments are let go of one by one.

    Args:
        births: one or more segments, in the order of events: within a world by birth number.
        deaths: segments; their world, id, tick and cause are enough.
        ends: tick at which each world stands, int64 (W,).
        begins: tick at the end of which the records begin.
    """
    born = _concatenated([_columns(segment, BirthCause) for segment in births])
    if len(ends) > 1:  # world by world; NumPy sorts numbers of 16 bits in linear time
        order = np.argsort(born["world"].astype(np.uint16), kind="stable")
        born = {name: array[order] for name, array in born.items()}
    ended, cause = ends[born["world"]], np.full(len(born["id"]), ALIVE, np.int8)
    for dead in (_columns(segment, Cause) for segment in deaths):
        rows = _rows(born["world"], born["id"], dead["world"], dead["id"])
        ended[rows], cause[rows] = dead["tick"], dead["cause"]
    return Lives(
        world=born["world"],
        id=born["id"],
        parent=born["parent"],
        cell=born["cell"],
        birth_cause=born["cause"],
        born=born["tick"],
        seen=np.maximum(born["tick"], begins) if begins else born["tick"],
        ended=ended,
        cause=cause,
    )


def _rows(
    worlds: np.ndarray, numbers: np.ndarray, world: np.ndarray, number: np.ndarray
) -> np.ndarray:
    """Return the row of each organism among others, int64 (n,), or -1 where it is not one of them.

    Args:
        worlds: of the others, (L,), not falling.
        numbers: birth numbers of the others, (L,), rising within a world.
        world: of those looked for, (n,).
        number: birth numbers of those looked for, (n,).
    """
    if not len(numbers):
        return np.full(len(number), -1)
    # Birth numbers mostly have no gaps up to the last of a world, so they are distances from its row.
    last = np.searchsorted(worlds, np.arange(2**16), side="right") - 1
    row = (last - numbers[last])[world] + number
    there = (row >= 0) & (row < len(numbers))
    row[~there] = 0
    there &= (numbers[row] == number) & (worlds[row] == world)
    row[~there] = -1
    rest = np.flatnonzero(~there & (number >= 0))
    if len(rest):  # those alive at a fork, and where lives were left out
        keys, wanted = _key(worlds, numbers), _key(world[rest], number[rest])
        found = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        row[rest] = np.where(keys[found] == wanted, found, -1)
    return row


def _key(world: np.ndarray, number: np.ndarray) -> np.ndarray:
    """One number for a world (below 2^16) and a birth number (below 2^47), in their order."""
    return world.astype(np.int64) << 47 | number


def _columns(segment: pa.Table, kind: type[Named]) -> dict[str, np.ndarray]:
    """Columns of births or deaths as arrays; nobody is -1, and causes are numbers of a kind."""
    arrays = {
        name: segment[name].fill_null(-1).to_numpy()
        for name in segment.column_names
        if name != "cause"
    }
    causes = segment["cause"].combine_chunks()
    codes = {each.label: each for each in kind}
    of_word = np.array([codes[word] for word in causes.dictionary.to_pylist()], np.int8)
    return {**arrays, "cause": of_word[causes.indices.to_numpy()]}


def _concatenated(parts: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Return the columns of all parts, which are emptied on the way."""
    return {name: np.concatenate([part.pop(name) for part in parts]) for name in list(parts[0])}
