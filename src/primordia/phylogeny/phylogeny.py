"""A phylogeny: organisms in the order of their births, their parents, and further facts."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from primordia.errors import Trouble
from primordia.history.ancestry import along
from primordia.history.islands import migrants
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives

MATE = "mate"
"""Name of the column, among the facts, that holds the second parent's birth number."""
ISLAND, MIGRATIONS = "island", "migrations"
"""Names of the columns, among the facts, that say where an organism was born, and how often its line has
moved to another island."""
Facts = dict[str, pa.Array]
"""Further columns by name, one value for each organism, null where there is none."""


@dataclass(frozen=True)
class Phylogeny:
    """L organisms, sorted by world and birth number, so that parents come before their children."""

    lives: Lives
    """the parent of an organism may be missing among them; see `rooted`"""
    of_births: Facts
    """`mate`, if the run has mates; `island` and `migrations`, if its worlds have islands; and the notes
    of its mutation"""
    of_deaths: Facts
    """energy left, food eaten, and the habitat's counts; null for the living"""

    def __len__(self) -> int:
        return len(self.lives)

    @property
    def mates(self) -> bool:
        """Whether organisms may have a second parent."""
        return MATE in self.of_births

    @cached_property
    def mate_row(self) -> np.ndarray | None:
        """Row of each organism's mate, int64 (L,), -1 without a mate; None if no organism has mates.

        Raises:
            Trouble: a mate is not older than the child.
        """
        if not self.mates:
            return None
        lives, mate = self.lives, self.of_births[MATE].fill_null(-1).to_numpy()
        if (young := mate >= lives.id).any():
            number = lives.id[young.argmax()]
            raise Trouble(f"the births are damaged: the mate of organism {number} is not older")
        return lives.rows_of(lives.world, mate)

    def take(self, rows: slice | np.ndarray) -> "Phylogeny":
        """Return the organisms in the given rows, which are in ascending order."""
        return Phylogeny(
            self.lives.take(rows), taken(self.of_births, rows), taken(self.of_deaths, rows)
        )

    def rooted(self) -> "Phylogeny":
        """Return the same organisms; an organism whose parent is missing becomes a root, with
        parent -1."""
        lives = self.lives
        parent = np.where(lives.parent_row < 0, -1, lives.parent)
        if (mate_row := self.mate_row) is None:
            return replace(self, lives=replace(lives, parent=parent))
        mate = pa.array(
            self.of_births[MATE].fill_null(-1).to_numpy(), mask=(mate_row < 0) | (parent < 0)
        )
        return Phylogeny(
            replace(lives, parent=parent), {**self.of_births, MATE: mate}, self.of_deaths
        )

    def with_migrations(self) -> "Phylogeny":
        """Return the same organisms, each with the migrations on its line of descent, if they have
        islands."""
        if ISLAND not in self.of_births:
            return self
        names = pc.dictionary_encode(self.of_births[ISLAND].cast(pa.string()))
        island, parent = names.indices.fill_null(-1).to_numpy(), self.lives.parent_row
        known = (island >= 0) & (island[parent] >= 0)  # a run of a fork may have no islands
        moved = along(parent, known & migrants(parent, island))
        return replace(self, of_births={**self.of_births, MIGRATIONS: pa.array(moved)})


def recorded(run: Archive) -> Phylogeny:
    """Return the organisms on record in one run.

    Raises:
        InputError: nothing has lived in the run yet.
        Trouble: the run's records are damaged.
    """
    lives, of_births = run.lives, {}
    if run.schema.mates:
        mate = run.mates_of(lives)
        of_births[MATE] = pa.array(mate, mask=mate < 0)
    if (islands := run.config.islands).count > 1:
        number = pa.array(islands.of_cells(lives.cell).astype(np.int16))
        of_births[ISLAND] = pa.DictionaryArray.from_arrays(number, pa.array(islands.names))
    notes = run.notes_of(lives)
    for place, name in enumerate(run.schema.notes):
        of_births[f"{name}_" if name in (ISLAND, MIGRATIONS) else name] = pa.array(notes[:, place])
    return Phylogeny(lives, of_births, _of_deaths(run, lives))


def _of_deaths(run: Archive, lives: Lives) -> Facts:
    """Return the facts in the table of deaths beside the end of each life."""
    whole = ("energy", "food")
    found = {name: np.zeros(len(lives)) for name in whole}
    found |= {name: np.zeros(len(lives), np.int32) for name in run.schema.tallies}
    for deaths in run.segments("deaths", ("world", "id", *found)):
        rows = lives.rows_of(deaths["world"].to_numpy(), deaths["id"].to_numpy())
        for name, values in found.items():
            values[rows] = deaths[name].to_numpy()
    alive = ~lives.died
    return {name: pa.array(found.pop(name), mask=alive) for name in list(found)}


def taken(facts: Facts, rows: slice | np.ndarray) -> Facts:
    """Return the facts in the given rows."""
    if isinstance(rows, slice):
        first, stop, _ = rows.indices(2**62)
        return {name: each.slice(first, stop - first) for name, each in facts.items()}
    places = pa.array(rows)
    return {name: each.take(places) for name, each in facts.items()}


def stacked(one: Facts, other: Facts, lengths: tuple[int, int]) -> Facts:
    """Return the facts of two groups of organisms one after another, null where a group has none."""
    kinds = {name: each.type for name, each in {**other, **one}.items()}
    return {
        name: pa.concat_arrays(
            [
                group[name].cast(kind) if name in group else pa.nulls(length, kind)
                for group, length in zip((one, other), lengths, strict=True)
            ]
        )
        for name, kind in kinds.items()
    }
