"""A table of an experiment, with a row for each world in CSV, and one for each group in Markdown."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import named
import numpy as np
import pandas as pd
from games import write_rows
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import primordia
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table
from primordia.figures import style
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


def illustrate(
    stem: Path,
    drawn: Callable[[pd.DataFrame], Figure],
    more: Callable[[pd.DataFrame], str] | None = None,
) -> None:
    """Draw the table that `measure` wrote, and append another one.

    Args:
        stem: the table's path without its suffix.
        drawn: returns a figure of the rows, which is kept as PNG.
        more: returns a second table of the rows, in Markdown.
    """
    rows, text = pd.read_csv(stem.with_suffix(".csv")), stem.with_suffix(".md")
    if more is not None:
        text.write_text(f"{text.read_text(encoding='utf-8').rstrip()}\n\n{more(rows)}\n", "utf-8")
    with style.applied():
        style.save(drawn(rows), stem)
    stem.with_suffix(".svg").unlink()


def dots(axes: Axes, groups: list[str], columns: list[list[pd.Series]], colours: list[str]) -> None:
    """Draw a column of dots, one for each world, for each colour of each group."""
    for place, of in enumerate(columns):
        for number, (values, colour) in enumerate(zip(of, colours, strict=True)):
            middle = place + (number - (len(of) - 1) / 2) * 0.8 / len(of)
            x = middle + np.linspace(-0.1, 0.1, len(values))
            axes.plot(x, np.sort(values), ".", color=colour, markersize=4, markeredgewidth=0)
    axes.set_xticks(range(len(groups)), groups)
