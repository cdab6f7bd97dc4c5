"""A table of an experiment, with a row for each world in CSV, and one for each arm in Markdown."""

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


def measure(file: Path, what: str, rows_of: Callable[[Records], list[Row]], note: str) -> None:
    """Measure all arms of an experiment, and write the table to `results/` beside its file.

    Args:
        file: the experiment's file; the experiment must have been run.
        what: the end of the name of the table's files.
        rows_of: returns a row for each world of an arm, with the world's `seed` first; "" is unknown.
        note: the text below the table.
    """
    rows: list[Row] = []
    for folder in named.arms(file):
        rows += [{"arm": folder.name, **row} for row in rows_of(primordia.load(folder).opened())]
        print(f"{folder.name} is done", flush=True)
    lines, columns = [], list(rows[0])[2:]
    for arm in dict.fromkeys(row["arm"] for row in rows):
        worlds = [row for row in rows if row["arm"] == arm]
        known = [[row[name] for row in worlds if row[name] != ""] for name in columns]
        lines.append([arm, len(worlds), *(spread_text(each) if each else "" for each in known)])
    text = f"{table(['arm', 'worlds', *columns], lines)}\n\nMedians over worlds (quartiles). {note}"
    write_rows(file.parent / "results" / f"{file.stem}-{what}", rows, text)
