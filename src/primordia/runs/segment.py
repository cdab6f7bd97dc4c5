"""Closed segments of a table: a Parquet file is read only if it has the table's columns."""

from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from primordia.errors import Trouble

NULLABLE = ("parent", "mate")
"""Columns that may have no value, for a founder or a child without a mate."""
MANY = 2**16
"""Smallest number of rows that several threads read faster than one thread does."""


def read(path: Path, rows: int, schema: pa.Schema, columns: Sequence[str] | None) -> pa.Table:
    """Return a segment, all columns or some.

    Args:
        path: the segment's file.
        rows: the number of rows that it must have.
        schema: the columns that it must have.
        columns: names of the wanted columns.

    Raises:
        Trouble: the file is not a segment of this table.
    """
    try:
        with pq.ParquetFile(path, pre_buffer=False) as file:
            found = {field.name: field.type for field in file.schema_arrow}
            wanted = {field.name: field.type for field in schema}
            if len(file.schema_arrow) != len(found) or found != wanted:
                raise Trouble(f"{path} is damaged: its columns are not those of this table")
            # Compared before reading, since a small file can hold very many equal rows.
            _check_count(path, file.metadata.num_rows, rows)
            table = file.read(columns, use_threads=rows >= MANY)
            names = list(columns) if columns else schema.names
            table = table.select(names).cast(pa.schema([schema.field(name) for name in names]))
    except (OSError, pa.ArrowException, MemoryError, ValueError) as error:
        message = str(error).partition("\n")[0]
        raise Trouble(f"{path} is damaged: {message}; restore it from a copy") from None
    _check_count(path, table.num_rows, rows)
    if any(table[name].null_count for name in table.column_names if name not in NULLABLE):
        raise Trouble(f"{path} is damaged: values are missing")
    return table


def _check_count(path: Path, found: int, rows: int) -> None:
    if found != rows:
        raise Trouble(f"{path} is damaged: it has {found} rows instead of {rows}")
