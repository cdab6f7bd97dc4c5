"""Do lives become longer step by step or in jumps? Change points in how long the dead had lived.

    python experiments/jumps.py experiments/robots/walker.toml

For experiments that have been run (`experiments/run.py`). In each world the lifespans of the dead, in the
order of their deaths and on a logarithmic scale, are parted into stretches of one mean each by PELT
(Killick, Fearnhead & Eckley 2012, with least squares). What a further stretch must gain is what the best
single cut gains in all but one of twenty shuffles of the same deaths: where order means nothing, a world
has no change point 19 times of 20. A change to longer lives is a jump, one to shorter lives a fall. Where
all are founders at the start, the first to die have lived short, whoever they are: a control without
heredity tells how many jumps are due to that. The table goes to `results/` beside the file, as Markdown
and CSV, world by world.
"""

import sys
from pathlib import Path
from typing import Any, NamedTuple

import files
import numpy as np
import ruptures
from games import write_rows

import primordia
from results import table

POINTS = 1000
"""of a world: means of as many of its dead in a row as it takes to have no more"""
SHORTEST = 10
"""points of a stretch"""
SHUFFLES = 400
RARE = 0.05
COLUMNS = ("late lifespan", "jumps", "falls", "largest jump", "longest plateau", "extinctions")


class Steps(NamedTuple):
    """A series of N points, parted into stretches of one mean each."""

    ends: list[int]
    """of each stretch, the last N"""
    means: np.ndarray

    @property
    def factors(self) -> np.ndarray:
        """By what the mean changes from each stretch to the next, where it is that of a logarithm."""
        return np.exp(np.diff(self.means))


def report(file: Path) -> None:
    """Find them, and write what came out."""
    rows = [row for run in files.runs(file) for row in steps_of(run)]
    write_rows(file.parent / "results" / f"{file.stem}-jumps", rows, summary(rows))


def steps_of(run: Path) -> list[dict[str, Any]]:
    """A row for each world."""
    found, rows = primordia.load(run), []
    everyone = found.lives()
    for told, number in zip(found.info()["worlds"], range(everyone.worlds), strict=True):
        mine = everyone.of_world(number)
        if not mine.died.any():
            sys.exit(f"{run}: in world {number} nobody has died; there are no lifespans to look at")
        dead = np.flatnonzero(mine.died)
        spans = mine.lifespan[dead[np.argsort(mine.ended[dead], kind="stable")]]
        series = pooled(np.log(np.maximum(spans, 1)))
        rows.append({"arm": run.name, "world": number, "dead": len(dead), **told_of(series)})
        rows[-1]["extinctions"] = told["extinctions"]
    return rows


def told_of(series: np.ndarray) -> dict[str, Any]:
    """What the steps of logarithms of lifespans (N,) come to."""
    steps = parted(series)
    sizes = np.diff([0, *steps.ends])
    return {
        "late lifespan": round(float(np.exp(steps.means[-1])), 1),
        "jumps": int((steps.factors > 1).sum()),
        "falls": int((steps.factors < 1).sum()),
        "largest jump": round(float(steps.factors.max(initial=1)), 2),
        "longest plateau": round(float(sizes.max() / len(series)), 3),
    }


def pooled(values: np.ndarray) -> np.ndarray:
    """Means of so many in a row that no more than POINTS are left."""
    size = -(-len(values) // POINTS)
    return values[: len(values) // size * size].reshape(-1, size).mean(axis=1)


def parted(series: np.ndarray) -> Steps:
    """A series (N,) in its stretches; one, if its order means nothing or it is too short."""
    ends = [len(series)]
    if len(series) >= 2 * SHORTEST:
        noise = np.random.default_rng(0)
        gains = [best_cut(noise.permutation(series)) for _ in range(SHUFFLES)]
        search = ruptures.KernelCPD(kernel="linear", min_size=SHORTEST).fit(series[:, None])
        ends = search.predict(pen=np.quantile(gains, 1 - RARE))
    return Steps(ends, np.array([part.mean() for part in np.split(series, ends[:-1])]))


def best_cut(series: np.ndarray) -> float:
    """By how much the best parting in two lowers the sum of squares."""
    left = np.arange(SHORTEST, len(series) - SHORTEST + 1)
    sums, right = np.cumsum(series - series.mean())[left - 1], len(series) - left
    return float((sums**2 / left + sums**2 / right).max())


def summary(rows: list[dict[str, Any]]) -> str:
    """Medians over worlds, with quartiles."""
    lines = []
    for arm in dict.fromkeys(row["arm"] for row in rows):
        mine = [row for row in rows if row["arm"] == arm]
        cells = [np.percentile([row[column] for row in mine], (50, 25, 75)) for column in COLUMNS]
        lines.append([arm, len(mine), *("{:,.4g} ({:,.4g} to {:,.4g})".format(*c) for c in cells)])
    note = (
        "Medians over worlds (quartiles). Lifespan: geometric mean of the last stretch, in ticks."
        " Largest jump: the factor by which lives become longer from one stretch to the next. Longest"
        " plateau: the longest stretch, as a share of all deaths."
    )
    return f"{table(['', 'worlds', *COLUMNS], lines)}\n\n{note}"


if __name__ == "__main__":
    files.each(report, __doc__)
