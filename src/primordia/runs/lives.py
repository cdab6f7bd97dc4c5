"""Lives: the births and deaths of a run, joined into one row for each organism."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np

from primordia.errors import InputError

LATE = 0.5
"""A birth is late if it comes after this share of its world's births."""
ALIVE = -1
"""The number for the living, in place of a cause of death."""


@dataclass(frozen=True)
class Lives:
    """Lives as arrays (L,), sorted by world and birth number.

    The living are censored at the last tick of their world.
    """

    world: np.ndarray
    """int32"""
    id: np.ndarray
    """int64, birth number within the world"""
    parent: np.ndarray
    """int64, birth number of the parent; -1 for a founder"""
    cell: np.ndarray
    """int32"""
    birth_cause: np.ndarray
    """int8, a `BirthCause`"""
    born: np.ndarray
    """int64, tick"""
    seen: np.ndarray
    """int64, tick from which the life is on record: birth, or the fork at which the organism was alive"""
    inherited: np.ndarray
    """bool: the organism was alive at the fork with which its run began"""
    ended: np.ndarray
    """int64, tick of death, or the world's last tick so far"""
    cause: np.ndarray
    """int8, a `Cause` of death, or ALIVE"""

    def __len__(self) -> int:
        return len(self.id)

    @property
    def lifespan(self) -> np.ndarray:
        """Ticks lived so far, int64 (L,)."""
        return self.ended - self.born

    @property
    def entered(self) -> np.ndarray:
        """Age from which the life is on record, int64 (L,): above 0 for organisms alive at a fork.

        Organisms that were born at the same times, but died before the fork, are not on record. So
        these lives carry no information about younger ages.
        """
        return self.seen - self.born

    @property
    def rank(self) -> np.ndarray:
        """Index in the world's order of birth, from 0, int64 (L,).

        The rank is the birth number, except in a fork, whose records leave out earlier deaths.
        """
        return np.arange(len(self)) - np.searchsorted(self.world, self.world)

    @property
    def died(self) -> np.ndarray:
        """Whether the organism is dead, bool (L,)."""
        return self.cause != ALIVE

    @property
    def worlds(self) -> int:
        """Number of worlds."""
        return int(self.world[-1]) + 1 if len(self) else 0

    def of_world(self, world: int) -> "Lives":
        """Return the lives of one world."""
        rows = self._rows_of_world(world)
        return self if rows == slice(0, len(self)) else self.take(rows)

    def check_world(self, world: int) -> None:
        """Raise InputError if nothing has lived in a world of this number."""
        if not 0 <= world < self.worlds:
            raise InputError(f"there is no world {world}; the worlds are 0 to {self.worlds - 1}")
        here = self._rows_of_world(world)
        if here.start == here.stop:
            raise InputError(f"nothing was born in world {world}")

    def by_world(self) -> "list[Lives]":
        """Return the lives of each world."""
        return [self.of_world(world) for world in range(self.worlds)]

    def recorded_since(self, tick: int) -> "Lives":
        """Return the lives that a fork at the end of a tick would record; 0 changes nothing."""
        later = self.take(np.flatnonzero(~self.died | (self.ended > tick)))
        inherited = later.inherited | alive_at_fork(later.born, tick)
        return replace(later, seen=np.maximum(later.seen, tick), inherited=inherited)

    def recorded_until(self, tick: int) -> "Lives":
        """Return the lives that a record stopped at the end of a tick would hold."""
        before = self.take(np.flatnonzero(self.born <= tick))
        late = before.ended > tick
        return replace(
            before,
            ended=np.where(late, tick, before.ended),
            cause=np.where(late, np.int8(ALIVE), before.cause),
        )

    def since_fork(self) -> "Lives":
        """Return the lives with time counted from the fork; organisms alive at the fork are born
        before 0."""
        inherited = self.inherited
        then = int(self.seen[inherited][0]) if inherited.any() else 0
        return replace(self, born=self.born - then, seen=self.seen - then, ended=self.ended - then)

    def late(self, after: float = LATE) -> np.ndarray:
        """Return whether each life began late, bool (L,).

        The argument `after` is a share of a world's births: the births that come after this share
        are late. Organisms that were alive at a fork were born before the fork, so they are not
        late and do not count.
        """
        own = ~self.inherited
        ordinal = np.cumsum(own) - 1  # index among the births of all worlds
        count = np.bincount(self.world[own], minlength=self.worlds)
        first_late = np.cumsum(count) - count + np.floor(after * count).astype(np.int64)
        return own & (ordinal >= first_late[self.world])

    def oldest(
        self, world: int | None = None, after: float = LATE, among: np.ndarray | None = None
    ) -> int:
        """Return the row of the longest late life, in one world or in all worlds; see `late`.

        Early organisms do not count, since a long-lived founder is not a product of evolution.
        Among equal lives the last-born wins, since time limits cut many lives at the same age.

        Args:
            world: number of the world.
            after: share of a world's births after which a birth is late.
            among: the organisms that count, bool (L,); by default all.

        Raises:
            InputError: there is no such world, or nothing was born since the fork.
        """
        here = slice(0, len(self))
        if world is not None:
            self.check_world(world)
            here = self._rows_of_world(world)
        rows = here.start + np.flatnonzero(self._late_among(among, after)[here])
        if not len(rows):
            when = "since the fork" if among is None else "late on this island"
            raise InputError(f"nothing has been born {when}; name an organism by its number")
        lifespan = self.lifespan[rows]
        return int(rows[len(rows) - 1 - np.argmax(lifespan[::-1])])

    def champions(self, among: np.ndarray | None = None) -> np.ndarray:
        """Return the row of the `oldest` organism of each world with a birth since the run began.

        With `among`, bool (L,), only those organisms count.
        """
        rows = np.flatnonzero(self._late_among(among))
        world, lifespan = self.world[rows], self.lifespan[rows]
        longest = np.zeros(self.worlds, lifespan.dtype)
        np.maximum.at(longest, world, lifespan)
        longest_lived = rows[lifespan == longest[world]]
        return longest_lived[np.flatnonzero(np.diff(self.world[longest_lived], append=-1))]

    def _late_among(self, among: np.ndarray | None, after: float = LATE) -> np.ndarray:
        late = self.late(after)
        return late if among is None else late & among

    def row(self, organism: int, world: int = 0) -> int:
        """Return the row of an organism.

        Raises:
            InputError: no such organism was born.
        """
        here = self._rows_of_world(world)
        row = here.start + int(np.searchsorted(self.id[here], organism))
        if row == here.stop or self.id[row] != organism:
            raise InputError(f"no organism {organism} was born in world {world}")
        return row

    def take(self, rows: slice | np.ndarray) -> "Lives":
        """Return the lives in the given rows."""
        return Lives(**{each.name: getattr(self, each.name)[rows] for each in fields(self)})

    @cached_property
    def parent_row(self) -> np.ndarray:
        """Row of each organism's parent, int64 (L,); -1 if the parent is not among these lives."""
        return self.rows_of(self.world, self.parent)

    def rows_of(self, world: np.ndarray, number: np.ndarray) -> np.ndarray:
        """Return the rows of organisms by world and birth number, int64 (n,); -1 if missing."""
        return find_rows(self.world, self.id, world, number)

    def _rows_of_world(self, world: int) -> slice:
        # Numbers of another dtype would make NumPy convert all rows.
        ends = [
            self.world.dtype.type(min(max(each, 0), self.worlds)) for each in (world, world + 1)
        ]
        return slice(*map(int, np.searchsorted(self.world, ends)))


def joined(parts: Sequence[Lives], firsts: np.ndarray) -> Lives:
    """Join the lives of R runs; `firsts`, int64 (R,), has the new number of each run's first world."""
    columns = {
        each.name: np.concatenate([getattr(part, each.name) for part in parts])
        for each in fields(Lives)
    }
    shift = np.repeat(firsts, [len(part) for part in parts]).astype(np.int32)
    return Lives(**{**columns, "world": columns["world"] + shift})


def alive_at_fork(born: np.ndarray, tick: int) -> np.ndarray:
    """Return whether organisms on record were born before a fork or in its tick, bool (L,).

    Args:
        born: ticks of their births, int64 (L,).
        tick: tick of the fork, at whose end the records begin; 0 if there was no fork.
    """
    return (born <= tick) & (tick > 0)


def find_rows(
    worlds: np.ndarray, numbers: np.ndarray, world: np.ndarray, number: np.ndarray
) -> np.ndarray:
    """Return the row of each wanted organism among the given organisms, int64 (n,); -1 if missing.

    Args:
        worlds: worlds of the given organisms, (L,), in ascending order.
        numbers: birth numbers of the given organisms, (L,), ascending within a world.
        world: worlds of the wanted organisms, (n,).
        number: birth numbers of the wanted organisms, (n,).
    """
    if not len(numbers):
        return np.full(len(number), -1)
    # Birth numbers mostly have no gaps up to the last of a world, so subtraction gives the row.
    last = np.searchsorted(worlds, np.arange(world.max(initial=0) + 1), side="right") - 1
    row = (last - numbers[last])[world] + number
    there = (row >= 0) & (row < len(numbers))
    row[~there] = 0
    there &= (numbers[row] == number) & (worlds[row] == world)
    row[~there] = -1
    rest = np.flatnonzero(~there & (number >= 0))
    if len(rest):  # there are gaps at a fork, or if lives were left out
        keys, wanted = _key(worlds, numbers), _key(world[rest], number[rest])
        nearest = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        row[rest] = np.where(keys[nearest] == wanted, nearest, -1)
    return row


def _key(world: np.ndarray, number: np.ndarray) -> np.ndarray:
    """Return one sortable number for a world (below 2^16) and a birth number (below 2^47)."""
    return world.astype(np.int64) << 47 | number
