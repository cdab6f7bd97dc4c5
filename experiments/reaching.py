"""How do arms reach their targets, where movement is free and where it costs?

    python experiments/reaching.py experiments/robots/reacher.toml experiments/robots/reacher-costly.toml

For experiments that have been run (`experiments/run.py`), of Reacher's tasks. In every world those that
have lived longest of all that are alive at the end live the last part of their lives again; beside them
the first founders, which nothing has selected. A target's time is from the tick in which it appears to
the one in which the next appears; its path is the way that the fingertip makes in this time, against the
shortest. One table of all files named goes to `results/` beside the first, as Markdown and CSV.
"""

import sys
from pathlib import Path
from typing import Any

import files
import numpy as np
from games import founders, spread, write_rows

import primordia
from primordia.organism.life.life import Life
from primordia.organism.organism import Organism
from results import table

EACH = 8
"""organisms of a world"""
TICKS = 5_000
"""of a life, its last"""
RATE = 50.0
"""ticks in a second"""
TARGET, SPEED, WAY = slice(4, 6), slice(6, 8), slice(8, 10)
"""of what arms perceive: the target's place, the joints' speeds, and from target to fingertip"""
COLUMNS = {
    "reached": "targets reached",
    "seconds": "seconds for each",
    "turned": "radians turned for each",
    "effort": "effort for each",
    "detour": "path, of the shortest",
    "hurry": "speed of the joints on arrival, rad/s",
}


def report(names: list[Path]) -> None:
    """Watch, and write what was seen."""
    rows = []
    for file in names:
        for run in files.runs(file):
            of = f"{file.stem}, {run.name}"
            rows += [told(f"{of}: founders", each) for each in founders(run)]
            rows += [told(of, each) for each in some_alive(run)]
    write_rows(names[0].parent / "results" / "reaching", rows, summary(rows))


def some_alive(run: Path) -> list[Organism]:
    """Of each world, those that have lived longest."""
    opened = primordia.load(run).opened()
    everyone, chosen = opened.lives, []
    for world in range(everyone.worlds):
        rows = np.flatnonzero(~everyone.died & (everyone.world == world))
        order = np.argsort(-everyone.lifespan[rows], kind="stable")
        chosen += [Organism(opened, int(row)) for row in rows[order[:EACH]]]
    return chosen


def told(who: str, organism: Organism) -> dict[str, Any]:
    """A row: what it does for a target."""
    life = Life.of(organism.run, organism.id, organism.world)
    senses = np.concatenate([stretch.senses for stretch in life.again()])[-TICKS:]
    found = {"who": who, "world": organism.world, "organism": organism.id, "age": organism.age}
    return {**found, **measured(senses)}


def measured(senses: np.ndarray) -> dict[str, float]:
    """Of senses, float32 (T, 11) as arms have them: COLUMNS; NaN where fewer than two were reached."""
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
    """Medians over worlds of each world's median, with the least and the most."""
    lines = []
    for name in dict.fromkeys(row["who"] for row in rows):
        mine = [row for row in rows if row["who"] == name]
        worlds = sorted({row["world"] for row in mine})
        here = [[row for row in mine if row["world"] == world] for world in worlds]
        cells = [told_of([known(rows, column) for rows in here]) for column in COLUMNS]
        lines.append([name, len(mine), *cells])
    note = (
        f"Medians over worlds (least to most) of the median in each world, of the last {TICKS:,} ticks of"
        f" the {EACH} oldest alive at the end, and of the first founder. Effort: squares of the joints'"
        " speeds, summed over ticks."
    )
    return f"{table(['', 'organisms', *COLUMNS.values()], lines)}\n\n{note}"


def known(rows: list[dict[str, Any]], column: str) -> list[float]:
    """Figures that there are."""
    return [row[column] for row in rows if np.isfinite(row[column])]


def told_of(worlds: list[list[float]]) -> str:
    """Spread of the medians of worlds that have one, and how many these are if not all."""
    medians = [float(np.median(each)) for each in worlds if each]
    if not medians:
        return "-"
    few = f", {len(medians)} worlds" * (len(medians) < len(worlds))
    return f"{spread(medians)}{few}"


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    report([Path(name) for name in sys.argv[1:]])
