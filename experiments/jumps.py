"""Do lives become longer step by step or in jumps? Change points in how long the dead had lived.

    python experiments/jumps.py experiments/robots/walker.toml

The experiments must have been run (`primordia experiment`). In each world, PELT (Killick, Fearnhead &
Eckley 2012, with least squares) parts the lifespans of the dead into stretches of one mean each.
Lifespans are in the order of deaths and on a logarithmic scale. A further stretch must gain more than
the best single cut gains in 19 of 20 shuffles of the same deaths. Where order means nothing, a world has
no change point 19 times of 20.

A smooth rise is parted too: its stretches are a staircase along it. So each world is also held against
smooth rises with its own noise. The rise is the isotonic regression of the series (Barlow, Bartholomew,
Bremner & Brunk 1972), averaged over a tenth of the deaths. The noise is what the regression leaves,
drawn in blocks, since neighbours are alike (Kuensch 1989). A jump is sudden if it is larger than the
largest jump is in 19 of 20 such rises. A rise in less than a tenth of the deaths counts as sudden.

A change to longer lives is a jump; a change to shorter lives is a fall. Where all organisms are founders
at the start, the first to die have short lives in any case. A control without heredity shows how many
jumps are due to that. The table goes to `results/` beside the file, as Markdown and CSV, world by world.
"""

import sys
from pathlib import Path
from typing import Any, NamedTuple

import named
import numpy as np
import ruptures
from games import write_rows
from scipy.optimize import isotonic_regression

import primordia
from primordia.experiments.results import table

POINTS = 1000
"""the most points of a world; each is the mean of a number of deaths in a row"""
SHORTEST = 10
"""the fewest points of a stretch"""
SHUFFLES = 400
RARE = 0.05
SMOOTH = 0.1
"""the share of a series over which a smooth rise is averaged"""
SURROGATES = 199
COLUMNS = (
    *("late lifespan", "jumps", "jumps if smooth", "sudden jumps", "p of the largest"),
    *("falls", "largest jump", "longest plateau", "extinctions"),
)


class Steps(NamedTuple):
    """A series of N points, parted into stretches of one mean each."""

    ends: list[int]
    """end of each stretch; the last is N"""
    means: np.ndarray

    @property
    def factors(self) -> np.ndarray:
        """Ratio of each stretch to the one before, if the series is of logarithms."""
        return np.exp(np.diff(self.means))

    @property
    def jumps(self) -> int:
        """Number of changes to a larger mean."""
        return int((self.factors > 1).sum())

    @property
    def largest(self) -> float:
        """The largest factor; 1 if there is no jump."""
        return float(self.factors.max(initial=1))


class Smooth(NamedTuple):
    """The steps of a series beside those of smooth rises with the same noise."""

    jumps: float
    """median number of jumps in smooth rises"""
    sudden: int
    """jumps larger than the largest of a smooth rise is in 19 of 20"""
    p: float
    """share of smooth rises whose largest jump is no smaller, with the series among them"""


def report(file: Path) -> None:
    """Find the jumps in each run of an experiment and write the table."""
    rows = [row for run in named.arms(file) for row in steps_of(run)]
    write_rows(file.parent / "results" / f"{file.stem}-jumps", rows, summary(rows))


def steps_of(run: Path) -> list[dict[str, Any]]:
    """Return a row for each world."""
    opened, rows = primordia.load(run), []
    lives = opened.lives()
    for number, world in enumerate(opened.info()["worlds"]):
        in_world = lives.of_world(number)
        if not in_world.died.any():
            sys.exit(f"{run}: no organism of world {number} has died; there are no lifespans")
        dead = np.flatnonzero(in_world.died)
        spans = in_world.lifespan[dead[np.argsort(in_world.ended[dead], kind="stable")]]
        series = pooled(np.log(np.maximum(spans, 1)))
        rows.append({"arm": run.name, "world": number, "dead": len(dead), **described(series)})
        rows[-1]["extinctions"] = world["extinctions"]
    return rows


def described(series: np.ndarray) -> dict[str, Any]:
    """Describe the steps in a series (N,) of logarithms of lifespans."""
    gain = penalty(series)
    steps = cut(series, gain)
    smooth = beside_smooth(series, steps, gain)
    sizes = np.diff([0, *steps.ends])
    return {
        "late lifespan": round(float(np.exp(steps.means[-1])), 1),
        "jumps": steps.jumps,
        "jumps if smooth": smooth.jumps,
        "sudden jumps": smooth.sudden,
        "p of the largest": smooth.p,
        "falls": int((steps.factors < 1).sum()),
        "largest jump": round(steps.largest, 2),
        "longest plateau": round(float(sizes.max() / len(series)), 3),
    }


def pooled(values: np.ndarray) -> np.ndarray:
    """Return means of equally many values in a row, at most POINTS of them."""
    size = -(-len(values) // POINTS)
    return values[: len(values) // size * size].reshape(-1, size).mean(axis=1)


def penalty(series: np.ndarray) -> float:
    """Return what a further stretch must gain; infinity for a series too short to be parted."""
    if len(series) < 2 * SHORTEST:
        return np.inf
    noise = np.random.default_rng(0)
    gains = [best_cut(noise.permutation(series)) for _ in range(SHUFFLES)]
    return float(np.quantile(gains, 1 - RARE))


def cut(series: np.ndarray, gain: float) -> Steps:
    """Part a series (N,) into stretches, each of which gains so much; into one if it is too short."""
    ends = [len(series)]
    if np.isfinite(gain):
        search = ruptures.KernelCPD(kernel="linear", min_size=SHORTEST).fit(series[:, None])
        ends = search.predict(pen=gain)
    return Steps(ends, np.array([part.mean() for part in np.split(series, ends[:-1])]))


def beside_smooth(series: np.ndarray, steps: Steps, gain: float) -> Smooth:
    """Hold the steps of a series (N,), cut at a gain, against those of smooth rises with its noise."""
    if not steps.jumps:
        return Smooth(0, 0, 1)
    rises = [cut(each, gain) for each in smooth_rises(series)]
    largest = np.array([rise.largest for rise in rises])
    sudden = int((steps.factors > np.quantile(largest, 1 - RARE)).sum())
    p = (1 + int((largest >= steps.largest).sum())) / (1 + SURROGATES)
    return Smooth(float(np.median([rise.jumps for rise in rises])), sudden, p)


def smooth_rises(series: np.ndarray) -> list[np.ndarray]:
    """Return smooth rises like a series (N,), with its noise in blocks of SHORTEST points."""
    fit, draw = isotonic_regression(series).x, np.random.default_rng(1)
    half = max(int(len(series) * SMOOTH / 2), 1)
    beyond = np.pad(fit, half, mode="reflect", reflect_type="odd")
    rise = np.convolve(beyond, np.full(2 * half + 1, 1 / (2 * half + 1)), mode="valid")
    starts = draw.integers(len(series), size=(SURROGATES, -(-len(series) // SHORTEST)))
    rows = (starts[:, :, None] + np.arange(SHORTEST)).reshape(SURROGATES, -1)[:, : len(series)]
    return list(rise + (series - fit)[rows % len(series)])


def best_cut(series: np.ndarray) -> float:
    """Return by how much the best parting in two lowers the sum of squares."""
    left = np.arange(SHORTEST, len(series) - SHORTEST + 1)
    sums, right = np.cumsum(series - series.mean())[left - 1], len(series) - left
    return float((sums**2 / left + sums**2 / right).max())


def summary(rows: list[dict[str, Any]]) -> str:
    """Return a table of medians over worlds, with quartiles."""
    lines = []
    for arm in dict.fromkeys(row["arm"] for row in rows):
        worlds = [row for row in rows if row["arm"] == arm]
        cells = [np.percentile([row[column] for row in worlds], (50, 25, 75)) for column in COLUMNS]
        lines.append(
            [arm, len(worlds), *("{:,.4g} ({:,.4g} to {:,.4g})".format(*c) for c in cells)]
        )
    note = (
        "Medians over worlds (quartiles). Lifespan: geometric mean of the last stretch, in ticks."
        " Jumps if smooth: those that a smooth rise with the same noise is parted into. Sudden jumps:"
        " those larger than the largest of such a rise is in 19 of 20. P of the largest: the share of"
        " smooth rises that have one as large."
        " Largest jump: the factor by which lives become longer from one stretch to the next. Longest"
        " plateau: the longest stretch, as a share of all deaths."
    )
    return f"{table(['', 'worlds', *COLUMNS], lines)}\n\n{note}"


if __name__ == "__main__":
    named.for_each_named(report, __doc__)
