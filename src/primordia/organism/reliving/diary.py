"""Files of a life, tick by tick: NumPy's .npz, Parquet or CSV."""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as csv
import pyarrow.parquet as pq

from primordia import files
from primordia.errors import InputError
from primordia.habitats.changing import Changed
from primordia.law.metabolism import ONE
from primordia.organism.reliving.instant import Stretch

Columns = dict[str, np.ndarray]
"""Values of n ticks by name, (n, ...) each."""


def check_name(path: Path) -> None:
    """Raise InputError unless the suffix is in WRITERS, and the path is free or a regular file."""
    files.check_output(path)
    if path.suffix not in WRITERS:
        raise InputError(f"{path}: the file of a life must end with one of {', '.join(WRITERS)}")


def write(path: Path, stretches: Iterator[Stretch], counts: tuple[str, ...]) -> None:
    """Write a life of one tick or more.

    Args:
        path: an .npz file, which is made in memory, or a .parquet or .csv file, which is written
            stretch by stretch.
        stretches: the life, in order.
        counts: names of the habitat's tallies.

    Raises:
        Trouble: the file cannot be written.
    """
    files.make_folder(path.parent)
    lived = (_columns(each, counts) for each in stretches)
    files.write(path, partial(WRITERS[path.suffix], lived))


def _columns(stretch: Stretch, counts: tuple[str, ...]) -> Columns:
    """Return the columns of a file; the columns that every life has come first."""
    own = {
        "tick": stretch.tick,
        "senses": stretch.senses,
        "action": stretch.action,
        "energy": stretch.energy / ONE,
        "food": stretch.eaten / ONE,
    }
    if isinstance(stretch.bodies, Changed):
        own["changes"] = np.asarray(stretch.bodies.course.times).sum(axis=1, dtype=np.int32)
    return own | {
        name: column
        for name, column in zip(counts, stretch.counts.T, strict=True)
        if name not in own
    }


def _npz(lived: Iterator[Columns], path: Path) -> None:
    parts = list(lived)
    whole = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    with path.open("wb") as file:  # np.savez would add a suffix to a name
        np.savez_compressed(file, allow_pickle=False, **whole)


def _table(writer: Callable[[Path, pa.Schema], Any], lived: Iterator[Columns], path: Path) -> None:
    first = _flat(next(lived))
    with writer(path, first.schema) as file:
        file.write_table(first)
        for each in lived:
            file.write_table(_flat(each))


def _flat(columns: Columns) -> pa.Table:
    """Return a table with a column for each number of a vector: `senses_0`, `senses_1`, ..."""
    numbers: Columns = {}
    for name, column in columns.items():
        if column.ndim == 1:
            numbers[name] = column
        else:
            numbers |= {f"{name}_{i}": each for i, each in enumerate(column.T)}
    return pa.table({name: pa.array(np.ascontiguousarray(each)) for name, each in numbers.items()})


WRITERS: dict[str, Callable[[Iterator[Columns], Path], None]] = {
    ".npz": _npz,
    ".parquet": partial(_table, pq.ParquetWriter),
    ".csv": partial(_table, csv.CSVWriter),
}
"""The writers of a life, by the suffix of the file."""
