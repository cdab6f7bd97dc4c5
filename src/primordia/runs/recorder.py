"""Records: births, deaths and metrics as Parquet tables in closed, immutable segments.

A segment is closed when it has 2^20 rows, or when a run ends. Later rows, the open tail, are part
of each checkpoint.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from primordia import files
from primordia.law.events import Events
from primordia.runs.digest import row_hashes
from primordia.runs.manifest import SEGMENT_ROWS, Segment
from primordia.runs.schema import TABLES, Schema


@dataclass
class Table:
    """One of the run's tables: its closed segments and its open tail."""

    name: str
    digest: np.ndarray
    """sum of the row hashes of each world, uint64 (W, 2)"""
    tail: list[np.ndarray] = field(default_factory=list)
    tail_rows: int = 0
    segments: list[Segment] = field(default_factory=list)


class Recorder:
    """The writer of a run's tables: it takes events and closes segments."""

    def __init__(self, run: Path | None, worlds: int, schema: Schema) -> None:
        """Begin empty tables in a run's directory; without a directory, keep only digests."""
        self._run, self.schema = run, schema
        self.tables = [Table(name, np.zeros((worlds, 2), np.uint64)) for name in TABLES]

    def append(self, events: Events) -> None:
        """Take the events of a chunk, and close segments that are full.

        Raises:
            Trouble: a segment cannot be written.
        """
        for table, rows in zip(self.tables, events, strict=True):
            count = int(rows.filled)
            if count:  # sliced on the host, since JAX would compile a slice for every new count
                self._add(table, np.asarray(rows.rows)[:count].copy())

    def add(self, name: str, rows: np.ndarray) -> None:
        """Take rows of one table, uint32 (n, fields)."""
        self._add(self.tables[TABLES.index(name)], rows)

    def _add(self, table: Table, rows: np.ndarray) -> None:
        hashes = row_hashes(self.schema.within_world(table.name, rows))
        np.add.at(table.digest, self.schema.world_of(table.name, rows), hashes)
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
        arrow = self.schema.arrow(table.name, rows)
        files.write(path, lambda temporary: pq.write_table(arrow, temporary, **_encoding(arrow)))
        sealed = files.seal(path)
        table.segments.append(Segment(name=path.name, rows=len(rows), **sealed))

    def tail(self, table: Table) -> np.ndarray:
        """Return the open tail, uint32 (n, fields)."""
        empty = np.zeros((0, self.schema.columns(table.name).width), np.uint32)
        return np.concatenate([empty, *table.tail])

    def set_tail(self, table: Table, rows: np.ndarray) -> None:
        """Replace the open tail."""
        table.tail, table.tail_rows = [rows], len(rows)

    def tails(self) -> dict[str, np.ndarray]:
        """Return all open tails by their names in a checkpoint."""
        return {f"tail.{table.name}": self.tail(table) for table in self.tables}

    def digests(self) -> dict[str, np.ndarray]:
        """Return the sums of row hashes of each table, uint64 (W, 2)."""
        return {table.name: table.digest for table in self.tables}

    def resume(
        self,
        segments: dict[str, list[Segment]],
        digests: dict[str, np.ndarray],
        tails: dict[str, np.ndarray],
    ) -> None:
        """Go on from the segments, digests and tails of a checkpoint."""
        for table in self.tables:
            table.segments = list(segments[table.name])
            table.digest = digests[table.name]
            self.set_tail(table, tails[f"tail.{table.name}"])


def _encoding(table: pa.Table) -> dict[str, Any]:
    """Return how the columns of a table are written.

    Birth numbers and ticks rise from row to row. As differences they take half of the space that they
    take in a dictionary, or less, and are read three times as fast.
    """
    numbers = [field.name for field in table.schema if field.type == pa.int64()]
    return {
        "use_dictionary": [name for name in table.column_names if name not in numbers],
        "column_encoding": dict.fromkeys(numbers, "DELTA_BINARY_PACKED"),
    }
