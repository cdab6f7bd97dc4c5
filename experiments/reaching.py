"""How do arms reach their targets, where movement is free and where it costs?

    python experiments/reaching.py experiments/robots/reacher.toml experiments/robots/reacher-costly.toml

The experiments must be of Reacher's tasks and must have been run (`primordia experiment`). In every world
the oldest organisms that are alive at the end live the last part of their lives again. The first founder
does the same, as a control without selection. A target's time is from the tick in which it appears to
the tick in which the next appears. Its path is the length of the fingertip's way in this time, over the
shortest way. One table of all files goes to `results/` beside the first file, as Markdown and CSV.
"""

import sys
from pathlib import Path
from typing import Any

import named
import numpy as np
from games import write_rows

import primordia
from primordia.comparison.tables import spread_text
from primordia.experiments.results import table
from primordia.organism.organism import Organism
from primordia.organism.reliving.relived import RelivedLife

EACH = 8
"""the number of organisms of a world that are watched"""
TICKS = 5_000
"""the number of last ticks of a life that are watched"""
RATE = 50.0
"""ticks in a second"""
TARGET, SPEED, WAY = slice(4, 6), slice(6, 8), slice(8, 10)
"""parts of the senses: the target's place, the joints' speeds, and the way from target to fingertip"""
COLUMNS = {
    "reached": "targets reached",
    "seconds": "seconds for each",
    "turned": "radians turned for each",
    "effort": "effort for each",
    "detour": "path, of the shortest",
    "hurry": "speed of the joints on arrival, rad/s",
}


def report(names: list[Path]) -> None:
    """Watch the arms of some experiments and write one table."""
    rows = []
    for file in names:
        for run in named.arms(file):
            name = f"{file.stem}, {run.name}"
            rows += [watched(f"{name}: founders", organism) for organism in founders(run)]
            rows += [watched(name, organism) for organism in some_alive(run)]
    write_rows(names[0].parent / "results" / "reaching", rows, summary(rows))


def founders(run: Path) -> list[Organism]:
    """Return the first organism that lived in each world."""
    opened = primordia.load(run).opened()
    return [Organism(opened, opened.lives.row(0, world)) for world in range(opened.lives.worlds)]


def some_alive(run: Path) -> list[Organism]:
    """Return the longest-lived organisms of each world that are alive at the end."""
    opened = primordia.load(run).opened()
    lives, chosen = opened.lives, []
    for world in range(lives.worlds):
        rows = np.flatnonzero(~lives.died & (lives.world == world))
        order = np.argsort(-lives.lifespan[rows], kind="stable")
        chosen += [Organism(opened, int(row)) for row in rows[order[:EACH]]]
    return chosen


def watched(name: str, organism: Organism) -> dict[str, Any]:
    """Live the end of an organism's life again and return a row of what it does for a target."""
    life = RelivedLife.of(organism.run, organism.id, organism.world)
    senses = np.concatenate([stretch.senses for stretch in life.stretches()])[-TICKS:]
    row = {"who": name, "world": organism.world, "organism": organism.id, "age": organism.age}
    return {**row, **measured(senses)}


def measured(senses: np.ndarray) -> dict[str, float]:
    """Return COLUMNS of an arm's senses, float32 (T, 11); NaN if fewer than two targets were reached."""
    target, speed = senses[:, TARGET], senses[:, SPEED]
    tip = target + senses[:, WAY]
    new = 1 + np.flatnonzero((np.diff(target, axis=0) != 0).any(axis=1))
    nothing = dict.fromkeys(COLUMNS, np.nan) | {"reached": len(new)}
    if len(new) < 2:
        return nothing
    first, last = new[0], new[-1]
    count, ticks = len(new) - 1, last - first
    moved, pressed = np.abs(speed[first:last]).sum(), (speed[first:last] ** 2).sum()
    path = np.linalg.norm(np.diff(tip[first : last + 1], axis=0), axis=1).sum()
    shortest = np.linalg.norm(tip[new[1:]] - tip[new[:-1]], axis=1).sum()
    return {
        "reached": len(new),
        "seconds": ticks / RATE / count,
        "turned": float(moved) / RATE / count,
        "effort": float(pressed) / count,
        "detour": float(path / shortest),
        "hurry": float(np.abs(speed[new[1:]]).sum(axis=1).mean()),
    }


def summary(rows: list[dict[str, Any]]) -> str:
    """Return a table of medians over worlds of each world's median, with quartiles."""
    lines = []
    for name in dict.fromkeys(row["who"] for row in rows):
        of_name = [row for row in rows if row["who"] == name]
        worlds = sorted({row["world"] for row in of_name})
        by_world = [[row for row in of_name if row["world"] == world] for world in worlds]
        cells = [medians_of([known(rows, column) for rows in by_world]) for column in COLUMNS]
        lines.append([name, len(of_name), *cells])
    note = (
        f"Medians over worlds (quartiles) of the median in each world, of the last {TICKS:,} ticks of"
        f" the {EACH} oldest alive at the end, and of the first founder. Effort: squares of the joints'"
        " speeds, summed over ticks."
    )
    return f"{table(['', 'organisms', *COLUMNS.values()], lines)}\n\n{note}"


def known(rows: list[dict[str, Any]], column: str) -> list[float]:
    """Return the figures of a column that are finite."""
    return [row[column] for row in rows if np.isfinite(row[column])]


def medians_of(worlds: list[list[float]]) -> str:
    """Return the spread of the worlds' medians, and how many worlds have one if not all do."""
    medians = [float(np.median(figures)) for figures in worlds if figures]
    if not medians:
        return "-"
    if len(medians) == len(worlds):
        return spread_text(medians)
    return f"{spread_text(medians)}, {len(medians)} worlds"


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    report([Path(name) for name in sys.argv[1:]])
