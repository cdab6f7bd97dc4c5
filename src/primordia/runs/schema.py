"""The schema of a run's tables: the law's words become Arrow columns."""

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pyarrow as pa

from primordia.engine.tallies import tally_columns
from primordia.errors import InputError
from primordia.law.columns import Columns
from primordia.law.events import DEATHS, birth_columns, sample_columns
from primordia.law.law import Law
from primordia.law.metabolism import ONE
from primordia.law.world import BirthCause, Cause, Named
from primordia.runs.description import Description

TABLES = ("births", "deaths", "metrics")


@dataclass(frozen=True)
class Schema:
    """The columns of a run's tables."""

    cells: int
    """cells of one world"""
    mates: bool
    """whether births have a mate"""
    notes: tuple[str, ...]
    """names of the mutation's notes at births"""
    rates: tuple[str, ...]
    """settings that seasons may change"""
    tallies: tuple[str, ...]
    """names of the habitat's counts"""
    endowed: bool = False
    """whether births have an endowment"""

    def __post_init__(self) -> None:
        """Raise InputError if a note, rate or tally has the name of another column."""
        added = {
            "births": self.notes,
            "deaths": self.tallies,
            "metrics": (*self.rates, *tally_columns(self.tallies)),
        }
        for table, names in added.items():
            for name in names:
                if names.count(name) > 1 or name in _own_columns()[table]:
                    raise InputError(
                        f"the table {table} would have two columns {name!r}; rename one of the"
                        " habitat's tallies or of the mutation's notes"
                    )

    @classmethod
    def of(cls, law: Law, tallies: tuple[str, ...]) -> "Schema":
        """Return the schema for a law and a habitat's tallies."""
        mates, endowed = law.heredity.recombination is not None, law.act is not None
        return cls(law.cells, mates, law.heredity.mutation.notes, law.rates, tallies, endowed)

    @classmethod
    def described(cls, cells: int, about: Description) -> "Schema":
        """Return the schema for the description of a run."""
        rates = tuple(about.beginning)
        return cls(cells, about.mates, about.notes, rates, about.tallies, about.endowed)

    def columns(self, table: str) -> Columns:
        """Return the columns of a table, as the law and the tallies pack them into words."""
        if table == "births":
            return birth_columns(self.mates, self.notes, self.endowed)
        if table == "deaths":
            return DEATHS.plus(*self.tallies)
        return sample_columns(self.rates).plus(*tally_columns(self.tallies))

    def world_of(self, table: str, rows: np.ndarray) -> np.ndarray:
        """Return the world to which each row belongs, (n,) from uint32 (n, words)."""
        return rows[:, 0] if table == "metrics" else rows[:, 0] // np.uint32(self.cells)

    def within_world(self, table: str, rows: np.ndarray) -> np.ndarray:
        """Return the rows with their world numbered 0."""
        own = rows.copy()
        own[:, 0] = 0 if table == "metrics" else rows[:, 0] % np.uint32(self.cells)
        return own

    def arrow(self, table: str, rows: np.ndarray) -> pa.Table:
        """Return rows as an Arrow table with names, units and types, from uint32 (n, words)."""
        words = self.columns(table).unpacked(rows)
        world = pa.array(self.world_of(table, rows).astype(np.int32))
        if table == "metrics":
            return pa.table({"world": world, **self._samples(words)})
        cell = (words["cell"] % np.uint32(self.cells)).astype(np.int32)
        if table == "births":
            return pa.table({"world": world, **self._births(words, cell)})
        return pa.table({"world": world, **self._deaths(words, cell)})

    def _births(self, words: dict[str, np.ndarray], cell: np.ndarray) -> dict[str, Any]:
        parent, mate, given = words["parent"], words.get("mate"), words.get("endowment")
        return {
            "id": words["id"],
            "parent": pa.array(parent, mask=parent == -1),
            "tick": words["tick"],
            "cell": cell,
            "cause": named(words["cause"], BirthCause),
            **({} if mate is None else {"mate": pa.array(mate, mask=mate == -1)}),
            **({} if given is None else {"endowment": given.view(np.int32) / ONE}),
            **{name: words[name].view(np.int32) for name in self.notes},
        }

    def _deaths(self, words: dict[str, np.ndarray], cell: np.ndarray) -> dict[str, Any]:
        return {
            "id": words["id"],
            "tick": words["tick"],
            "cell": cell,
            "cause": named(words["cause"], Cause),
            "energy": words["energy"].view(np.int32) / ONE,
            "food": words["food"].view(np.int32) / ONE,
            **{name: words[name].view(np.int32) for name in self.tallies},
        }

    def _samples(self, words: dict[str, np.ndarray]) -> dict[str, Any]:
        population = words["population"].astype(np.int32)
        living = np.maximum(population, 1)
        deaths = [name for name in words if name.startswith("deaths_")]
        counts = ["births", *deaths, "extinctions", "organism_ticks", "oldest_age"]
        return {
            "tick": words["tick"],
            "population": population,
            **{name: words[name] for name in counts},
            "mean_age": words["age_total"] / living,
            "mean_energy": words["energy_total"] / ONE / living,
            "food": words["food_total"] / ONE,
            **{name: words[name].view(np.float32) for name in self.rates},
            **{
                name: words[name].view(np.float32 if name.endswith("_mean") else np.int32)
                for name in tally_columns(self.tallies)
            },
        }


@cache
def _own_columns() -> dict[str, set[str]]:
    """Return the names of columns and of words that each table has in every run."""
    plain = Schema(cells=2, mates=True, notes=(), rates=(), tallies=(), endowed=True)
    columns = {table: plain.columns(table) for table in TABLES}
    return {
        table: {*own.names, *plain.arrow(table, np.zeros((0, own.width), np.uint32)).schema.names}
        for table, own in columns.items()
    }


def named(codes: np.ndarray, names: type[Named], none: np.ndarray | None = None) -> pa.Array:
    """Return causes by their names, from their numbers (n,); null where `none`, bool (n,), is true."""
    labels = pa.array([each.label for each in names])
    return pa.DictionaryArray.from_arrays(pa.array(codes.astype(np.int8), mask=none), labels)
