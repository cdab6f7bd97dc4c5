"""A phylogeny as a file for other programs; its suffix says in which format."""

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq

from primordia import files
from primordia.errors import InputError
from primordia.phylogeny.newick import newick
from primordia.phylogeny.phylogeny import Phylogeny
from primordia.phylogeny.table import batch, batches

NODE = "strain"
"""The first column of Taxonium's metadata. It holds the labels of a tree; `newick_to_taxonium`
looks for its name."""
OF_TREES = ("ancestor_list", "ancestor_id")
"""Columns that are not needed beside a tree."""


def save(whole: Phylogeny, out: Path, say: Callable[[str], object]) -> None:
    """Write a phylogeny to .parquet, .csv, .nwk, .newick or .tsv; see docs/how-to/phylogeny.md.

    Args:
        whole: the phylogeny.
        out: path of the file.
        say: called with a line if the format cannot hold all of the phylogeny.

    Raises:
        InputError: there is no such format, or the path exists and is not a regular file.
        Trouble: the file cannot be written.
    """
    write = check_suffix(out)
    if write is _newick and whole.mates:
        say(f"{out}: a tree has one parent for each child, so mates are left out")
    files.write(out, lambda path: write(whole, path))


def check_suffix(out: Path) -> Callable[[Phylogeny, Path], None]:
    """Return the function that writes the format of a path; raise InputError if there is none."""
    try:
        return FORMATS[out.suffix.lower()]
    except KeyError:
        raise InputError(f"{out}: the name must end with one of {', '.join(FORMATS)}") from None


def _parquet(whole: Phylogeny, path: Path) -> None:
    with pq.ParquetWriter(path, batch(whole.take(slice(0, 0))).schema) as file:
        for each in batches(whole):
            file.write_batch(each)


def _csv(whole: Phylogeny, path: Path) -> None:
    """Write the table as in the standard; lists of two parents are quoted, since they hold commas."""
    _separated(whole, path, ",", lambda rows: rows, "needed" if whole.mates else "none")


def _taxonium(whole: Phylogeny, path: Path) -> None:
    """Write metadata for Taxonium: the node names first, then the facts of each node."""

    def metadata(rows: pa.RecordBatch) -> pa.RecordBatch:
        rows = rows.drop_columns(list(OF_TREES))
        return rows.rename_columns([NODE, *rows.schema.names[1:]])

    _separated(whole, path, "\t", metadata, "none")


def _separated(
    whole: Phylogeny,
    path: Path,
    delimiter: str,
    chosen: Callable[[pa.RecordBatch], pa.RecordBatch],
    quoting: str,
) -> None:
    """Write a header and rows with a delimiter between values; no value is an empty text."""
    header = chosen(batch(whole.take(slice(0, 0)))).schema.names
    options: Any = {"include_header": False, "delimiter": delimiter, "quoting_style": quoting}
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, delimiter=delimiter, lineterminator="\n").writerow(header)
    with path.open("ab") as file:
        for each in batches(whole):
            pa.csv.write_csv(chosen(each), file, pa.csv.WriteOptions(**options))


def _newick(whole: Phylogeny, path: Path) -> None:
    with path.open("wb") as file:
        file.writelines(newick(whole))


FORMATS: dict[str, Callable[[Phylogeny, Path], None]] = {
    ".parquet": _parquet,
    ".csv": _csv,
    ".nwk": _newick,
    ".newick": _newick,
    ".tsv": _taxonium,
}
"""The functions that write the formats, by the suffix of the file."""
