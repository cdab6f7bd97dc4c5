"""Islands in a page: where they are, a table of who lives on them, and their curves."""

from typing import Any

import numpy as np

from primordia.figures import style
from primordia.figures.islands import by_island
from primordia.history import series
from primordia.history.islands import on_islands
from primordia.report.curves import Panel, over_worlds, panel
from primordia.runs.records import Records
from primordia.settings.islands import Islands

WORLDS = 6
"""Largest number of worlds in the table."""
HEAD = (
    "island", "cells", "living", "mean age (ticks)", "born here", "of these, with a parent elsewhere",
)  # fmt: skip
ABOUT = (
    "An island is a part of the world's cells with a habitat and rates of its own. An organism lives"
    " where it was born."
)


def places(islands: Islands) -> list[dict[str, Any]]:
    """Return name, colour, first and last cell of each island, for `islands.js`."""
    colours = style.island_colours(islands.names)
    return [
        {"name": name, "colour": colours[name], "first": cells.start, "last": cells.stop - 1}
        for name, cells in zip(islands.names, islands.cells, strict=True)
    ]


def overview(run: Records) -> dict[str, Any] | None:
    """Return the section on islands, for `islands.js`; None if the worlds have no islands.

    Returns:
        `about`; `places`; and `table`: its `title`, `head` and `rows` of texts.
    """
    islands = run.config.islands
    if islands.count == 1:
        return None
    seeds, several = run.world_seeds, run.lives.worlds > 1
    rows = []
    for each in on_islands(run):
        if each.world >= WORLDS:
            break
        name = f"seed {seeds[each.world]}, {each.name}" if several else each.name
        age = "-" if each.mean_age is None else f"{each.mean_age:,.0f}"
        counts = (f"{n:,}" for n in (each.cells, each.living))
        arrived = f"{each.immigrants:,}"
        if each.births:
            arrived += f" ({100 * each.immigrants / each.births:.0f} %)"
        rows.append([name, *counts, age, f"{each.births:,}", arrived])
    title = "Islands of the first worlds" if run.lives.worlds > WORLDS else "Now, on each island"
    table = {"title": title, "head": list(HEAD), "rows": rows}
    return {"about": ABOUT, "places": places(islands), "table": table}


def panels(run: Records) -> list[Panel]:
    """Return curves of the islands; [] if the worlds have no islands."""
    islands, lives = run.config.islands, run.lives.since_fork()
    if islands.count == 1:
        return []
    ticks, time = series.moments(int(lives.ended.max())), style.time_label(lives)
    sizes = np.array(islands.sizes)[:, None, None]
    full = by_island(series.population, lives, islands, ticks) / sizes
    ages = series.positive(by_island(series.mean_age, lives, islands, ticks))
    colours = style.island_colours(islands.names)

    def tables(values: np.ndarray) -> list[dict[str, Any]]:
        return [
            over_worlds(name, ticks, own, colour, each=False)
            for own, (name, colour) in zip(values, colours.items(), strict=True)
        ]

    return [
        panel(
            "Inhabited cells of each island", "The share of each island's cells in which an organism"
            " lives, over time.", time, "share of its cells", tables(full), log_x=True,
        ),
        panel(
            "Mean age on each island", "The mean age of the living of each island over time.", time,
            "age (ticks)", tables(ages), log_x=True, log_y=True,
        ),
    ]  # fmt: skip
