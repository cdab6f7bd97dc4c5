"""Records: births, deaths and metrics as Parquet tables in closed, immutable segments.

A segment is closed when it has 2^20 rows, or when a run comes to its end. Rows that are in none yet (the
open tail) are part of each checkpoint.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from primordia import files
from primordia.engine.tallies import tally_columns
from primordia.law.events import BIRTH_FIELDS, DEATH_FIELDS, Events
from primordia.law.metabolism import ONE
from primordia.law.sample import WIDE_COLUMNS, climate_columns
from primordia.law.world import Cause, Origin
from primordia.runs.digest import row_hashes

TABLES = ("births", "deaths", "metrics")
SEGMENT_ROWS = 2**20


@dataclass
class Table:
    """One of the run's tables: its closed segments and its open tail."""

    name: str
    fields: tuple[str, ...]
    """names of the words of a row as the law gives it"""
    to_arrow: Callable[[np.ndarray, np.ndarray], pa.Table]
    """(rows uint32 (n, fields), world of each) -> table"""
    tail: list[np.ndarray]
    tail_rows: int
    segments: list[dict[str, object]]
    digest: np.ndarray
    """sum of the row hashes of each world, uint64 (W, 2)"""


class Recorder:
    """Takes events, closes segments."""

    def __init__(
        self,
        run: Path | None,
        worlds: int,
        cells: int,
        blocks: list[str],
        tallies: tuple[str, ...] = (),
    ) -> None:
        """`run` is the run's directory; None keeps digests only. Tallies are what the habitat counts."""
        self._run, self._worlds, self._cells = run, worlds, cells
        samples = (*sample_fields(blocks), *tally_columns(tallies))
        self.tables = [
            self._table("births", BIRTH_FIELDS, _births(cells)),
            self._table("deaths", (*DEATH_FIELDS, *tallies), _deaths(cells, tallies)),
            self._table("metrics", samples, _metrics(blocks, tallies)),
        ]

    def _table(self, name: str, fields: tuple[str, ...], to_arrow: Callable) -> Table:
        return Table(name, fields, to_arrow, [], 0, [], np.zeros((self._worlds, 2), np.uint64))

    def append(self, events: Events) -> None:
        """Take the events of a chunk; closes segments as they fill.

        Raises:
            Trouble: a segment cannot be written.
        """
        for table, rows in zip(self.tables, events, strict=True):
            count = int(rows.filled)
            if count:  # cut on the host: JAX would compile a slice anew for every count
                self._add(table, np.asarray(rows.rows)[:count].copy())

    def add(self, name: str, rows: np.ndarray) -> None:
        """Take rows of one table, uint32 (n, fields)."""
        self._add(self.tables[TABLES.index(name)], rows)

    def _add(self, table: Table, rows: np.ndarray) -> None:
        hashes, worlds = row_hashes(self._within_world(table, rows)), self.world_of(table, rows)
        np.add.at(table.digest, worlds, hashes)
        if self._run is None:
            return
        table.tail.append(rows)
        table.tail_rows += len(rows)
        while table.tail_rows >= SEGMENT_ROWS:
            joined = self.tail(table)
            self._close(table, joined[:SEGMENT_ROWS])
            self.set_tail(table, joined[SEGMENT_ROWS:])

    def finish(self) -> None:
        """Close the tails, so that other programs find every row in a segment."""
        for table in self.tables:
            if table.tail_rows:
                self._close(table, self.tail(table))
                self.set_tail(table, self.tail(table)[:0])

    def _close(self, table: Table, rows: np.ndarray) -> None:
        assert self._run is not None
        path = self._run / table.name / f"{len(table.segments):06d}.parquet"
        arrow = table.to_arrow(rows, self.world_of(table, rows))
        files.write(path, lambda temporary: pq.write_table(arrow, temporary))
        table.segments.append({"name": path.name, "rows": len(rows), **files.seal(path)})

    def tail(self, table: Table) -> np.ndarray:
        """The open tail, uint32 (n, fields)."""
        empty = np.zeros((0, len(table.fields)), np.uint32)
        return np.concatenate([empty, *table.tail])

    def set_tail(self, table: Table, rows: np.ndarray) -> None:
        """Replace the open tail."""
        table.tail, table.tail_rows = [rows], len(rows)

    def tails(self) -> dict[str, np.ndarray]:
        """All open tails by the names they have in a checkpoint."""
        return {f"tail.{table.name}": self.tail(table) for table in self.tables}

    def digests(self) -> dict[str, np.ndarray]:
        """Of each table the sums of row hashes, uint64 (W, 2)."""
        return {table.name: table.digest for table in self.tables}

    def resume(
        self,
        segments: dict[str, list[dict[str, object]]],
        digests: dict[str, np.ndarray],
        tails: dict[str, np.ndarray],
    ) -> None:
        """Go on from what a checkpoint says."""
        for table in self.tables:
            table.segments = list(segments[table.name])
            table.digest = digests[table.name]
            self.set_tail(table, tails[f"tail.{table.name}"])

    def arrow(self, name: str, tail: np.ndarray) -> pa.Table:
        """Rows of an open tail as they would be in a segment."""
        table = self.tables[TABLES.index(name)]
        return table.to_arrow(tail, self.world_of(table, tail))

    def world_of(self, table: Table, rows: np.ndarray) -> np.ndarray:
        """The world each row belongs to."""
        return rows[:, 0] if table.name == "metrics" else rows[:, 0] // np.uint32(self._cells)

    def _within_world(self, table: Table, rows: np.ndarray) -> np.ndarray:
        """The rows as they would be if their world were the only one."""
        own = rows.copy()
        own[:, 0] = 0 if table.name == "metrics" else rows[:, 0] % np.uint32(self._cells)
        return own


def sample_fields(blocks: list[str]) -> tuple[str, ...]:
    """Words of a sample."""
    pairs = [f"{name}.{half}" for name in WIDE_COLUMNS for half in ("hi", "lo")]
    return ("world", "population", *pairs, *climate_columns(blocks))


def _wide(rows: np.ndarray, column: int) -> np.ndarray:
    """Two words as int64."""
    hi, lo = rows[:, column].astype(np.int64), rows[:, column + 1].astype(np.int64)
    return hi << 32 | lo


def _named(codes: np.ndarray, names: type[Origin] | type[Cause]) -> pa.Array:
    words = pa.array([each.label for each in names])
    return pa.DictionaryArray.from_arrays(pa.array(codes.astype(np.int8)), words)


def _units(steps: np.ndarray) -> np.ndarray:
    return steps.astype(np.uint32).view(np.int32) / ONE


def _births(cells: int) -> Callable[[np.ndarray, np.ndarray], pa.Table]:
    def to_arrow(rows: np.ndarray, worlds: np.ndarray) -> pa.Table:
        parent = _wide(rows, 3)
        return pa.table(
            {
                "world": pa.array(worlds.astype(np.int32)),
                "id": _wide(rows, 1),
                "parent": pa.array(parent, mask=parent == -1),
                "tick": _wide(rows, 5),
                "cell": (rows[:, 0] % np.uint32(cells)).astype(np.int32),
                "cause": _named(rows[:, 7], Origin),
            }
        )

    return to_arrow


def _deaths(cells: int, tallies: tuple[str, ...]) -> Callable[[np.ndarray, np.ndarray], pa.Table]:
    def to_arrow(rows: np.ndarray, worlds: np.ndarray) -> pa.Table:
        return pa.table(
            {
                "world": pa.array(worlds.astype(np.int32)),
                "id": _wide(rows, 1),
                "tick": _wide(rows, 3),
                "cell": (rows[:, 0] % np.uint32(cells)).astype(np.int32),
                "cause": _named(rows[:, 5], Cause),
                "energy": _units(rows[:, 6]),
                "food": _units(rows[:, 7]),
                **{name: column.view(np.int32) for name, column in _last(rows, tallies)},
            }
        )

    return to_arrow


def _last(rows: np.ndarray, names: Sequence[str]) -> Iterator[tuple[str, np.ndarray]]:
    """The last columns, by name."""
    first = rows.shape[1] - len(names)
    return zip(names, np.ascontiguousarray(rows[:, first:].T), strict=True)


def _metrics(
    blocks: list[str], tallies: tuple[str, ...]
) -> Callable[[np.ndarray, np.ndarray], pa.Table]:
    def to_arrow(rows: np.ndarray, worlds: np.ndarray) -> pa.Table:
        wide = {name: _wide(rows, 2 + 2 * i) for i, name in enumerate(WIDE_COLUMNS)}
        population = rows[:, 1].astype(np.int32)
        living = np.maximum(population, 1)
        wide["mean_age"] = wide.pop("age_total") / living
        wide["mean_energy"] = wide.pop("energy_total") / ONE / living
        wide["food"] = wide.pop("food_total") / ONE
        names, start = climate_columns(blocks), 2 + 2 * len(WIDE_COLUMNS)
        values = np.ascontiguousarray(rows[:, start : start + len(names)]).view(np.float32)
        climate = dict(zip(names, values.T, strict=True))
        for name, column in _last(rows, tally_columns(tallies)):
            climate[name] = column.view(np.float32 if name.endswith("_mean") else np.int32)
        tick = wide.pop("tick")
        world = pa.array(worlds.astype(np.int32))
        return pa.table({"world": world, "tick": tick, "population": population, **wide, **climate})

    return to_arrow
