"""A table of an experiment, with a row for each world in CSV, and one for each group in Markdown."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import named
from games import write_rows

import primordia
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table
from primordia.runs.records import Records

Row = dict[str, Any]


def measure(file: Path, what: str, rows_of: Callable[[Records], list[Row]], note: str) -> Path:
    """Measure all arms of an experiment, and write the table to `results/` beside its file.

    Return the table's path without its suffix.

    Args:
        file: the experiment's file; the experiment must have been run.
        what: the end of the name of the table's files.
        rows_of: returns a row for each world of an arm, with the world's `seed` first; "" is unknown.
            If there are columns before `seed`, the worlds of each of their values are a group.
        note: the text below the table.
    """
    rows: list[Row] = []
    for folder in named.arms(file):
        rows += [{"arm": folder.name, **row} for row in rows_of(primordia.load(folder).opened())]
        print(f"{folder.name} is done", flush=True)
    lines, names = [], list(rows[0])
    marks, columns = names[: names.index("seed")], names[names.index("seed") + 1 :]
    for group in dict.fromkeys(tuple(row[mark] for mark in marks) for row in rows):
        worlds = [row for row in rows if tuple(row[mark] for mark in marks) == group]
        known = [[row[name] for row in worlds if row[name] != ""] for name in columns]
        lines.append([*group, len(worlds), *(spread_text(each) if each else "" for each in known)])
    text = (
        f"{table([*marks, 'worlds', *columns], lines)}\n\nMedians over worlds (quartiles). {note}"
    )
    stem = file.parent / "results" / f"{file.stem}-{what}"
    write_rows(stem, rows, text)
    return stem
