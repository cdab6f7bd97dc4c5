"""Everyone who ever lived in a run, one row each: births and deaths joined."""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import pyarrow as pa

from primordia.errors import InputError
from primordia.law.world import Cause, Named, Origin
from primordia.runs.report import opened, table, world_ticks

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
    origin: np.ndarray
    """int8, an `Origin`"""
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
        first, last = np.searchsorted(self.world, [world, world + 1])
        return self.take(slice(first, last))

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

    def oldest(self) -> int:
        """Row of the longest life, of equals the first."""
        return int(np.argmax(self.lifespan))

    def row(self, organism: int, world: int = 0) -> int:
        """Where an organism stands.

        Raises:
            InputError: no such organism was born.
        """
        row = int(np.searchsorted(_key(self.world, self.id), (int(world) << 47) + int(organism)))
        if row == len(self) or (self.world[row], self.id[row]) != (world, organism):
            raise InputError(f"no organism {organism} was born in world {world}")
        return row

    def take(self, rows: slice | np.ndarray) -> "Lives":
        """Those in the given rows."""
        return Lives(**{each.name: getattr(self, each.name)[rows] for each in fields(self)})

    @cached_property
    def parent_row(self) -> np.ndarray:
        """Row of each one's parent, int64 (L,), or -1 where it is not among these."""
        keys = _key(self.world, self.id)
        wanted = _key(self.world, self.parent)
        rows = np.minimum(np.searchsorted(keys, wanted), max(len(keys) - 1, 0))
        return np.where((self.parent >= 0) & (keys[rows] == wanted), rows, -1)


def lives(run: Path) -> Lives:
    """All lives of a run, up to its newest checkpoint.

    Raises:
        InputError: this is no run, or nothing has lived in it yet.
    """
    config, last = opened(run)
    ends = world_ticks(last.arrays()).astype(np.int64)
    born = _by_life(table(run, "births"), Origin)
    if not len(born["id"]):
        raise InputError(f"{run} is empty: nothing has lived in it yet")
    dead = _by_life(table(run, "deaths"), Cause)
    rows = np.searchsorted(_key(born["world"], born["id"]), _key(dead["world"], dead["id"]))
    ended, cause = ends[born["world"]], np.full(len(born["id"]), ALIVE, np.int8)
    ended[rows], cause[rows] = dead["tick"], dead["cause"]
    return Lives(
        world=born["world"],
        id=born["id"],
        parent=born["parent"],
        cell=born["cell"],
        origin=born["cause"],
        born=born["tick"],
        seen=np.maximum(born["tick"], config.begins),
        ended=ended,
        cause=cause,
    )


def _key(world: np.ndarray, number: np.ndarray) -> np.ndarray:
    """One number for a world (below 2^16) and a birth number (below 2^47), in their order."""
    return world.astype(np.int64) << 47 | number


def _by_life(found: pa.Table, kind: type[Named]) -> dict[str, np.ndarray]:
    """Columns of a table of births or deaths, sorted by world and birth number; nobody is -1."""
    columns = {name: found[name].combine_chunks() for name in found.column_names}
    codes = {each.label: each for each in kind}
    cause = columns.pop("cause")
    of_word = np.array([codes[word] for word in cause.dictionary.to_pylist()], np.int8)
    arrays = {name: column.fill_null(-1).to_numpy() for name, column in columns.items()}
    arrays["cause"] = of_word[cause.indices.to_numpy()]
    order = np.argsort(_key(arrays["world"], arrays["id"]), kind="stable")
    return {name: array[order] for name, array in arrays.items()}
