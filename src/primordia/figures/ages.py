"""The paper's figure of increasing lifespans: ages of the living, and lifespans of the dead."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history import series
from primordia.runs.lives import Lives
from primordia.runs.records import Records

DOTS = 3000
"""Largest number of dots for the dead, and for the living."""
BINS, ENOUGH = 40, 30
"""Largest number of bins of birth order, and the number of dead that a bin needs for quartiles."""


def draw(run: Records, world: int) -> Figure:
    """Draw mean age against time and against births, and lifespans of the dead by birth order."""
    lives = run.lives.since_fork()
    figure = Figure(figsize=(style.PAGE, 2.4))
    over_time, over_births, dead = figure.subplots(1, 3, sharey=True)
    worlds = lives.by_world()
    _over_time(over_time, worlds, style.time_label(lives))
    _over_births(over_births, worlds)
    _lifespans(dead, lives)
    style.logarithmic(dead.yaxis)
    dead.set_ylim(1, None)
    return figure


def _over_time(axes: Axes, worlds: list[Lives], time: str) -> None:
    ticks = series.moments(max(int(world.ended.max()) for world in worlds))
    style.curves(
        axes, ticks, series.positive(series.curve_by_world(series.mean_age, worlds, ticks))
    )
    style.time_axis(axes, int(ticks[-1]), time)
    style.title(axes, "Mean age of the living over time", style.worlds_key(len(worlds)))
    axes.set_ylabel("age (ticks)")


def _over_births(axes: Axes, worlds: list[Lives]) -> None:
    longest = max(map(len, worlds))
    number = np.unique(np.linspace(1, longest, series.POINTS).astype(np.int64))
    ages = np.full((len(worlds), len(number)), np.nan)
    for row, world in zip(ages, worlds, strict=True):
        here = number[number <= len(world)]
        row[: len(here)] = series.mean_age(world, world.seen[here - 1])
    style.curves(axes, number, series.positive(ages))
    style.linear(axes.xaxis)
    style.title(axes, "Mean age of the living over births", style.worlds_key(len(worlds)))
    axes.set(xlabel="organisms born so far", xlim=(0, longest + 1))


def _lifespans(axes: Axes, lives: Lives) -> None:
    number, lifespan, died = lives.rank + 1, lives.lifespan, lives.died
    for group, colour in ((died, style.SKY), (~died, style.ORANGE)):
        some = np.flatnonzero(group)[:: int(group.sum()) // DOTS + 1]
        axes.plot(
            number[some], np.maximum(lifespan[some], 1), ".", color=colour, markersize=2.5,
            markeredgewidth=0, alpha=0.6, rasterized=True,
        )  # fmt: skip
    style.linear(axes.xaxis)
    axes.set(xlabel="organism, in order of birth", xlim=(0, number.max() + 1))
    key = {"dead": style.SKY, "median and quartiles": style.BLUE, "still alive": style.ORANGE}
    style.title(axes, "Lifespan of each organism", key)
    if not died.any():
        style.remark(axes, "no deaths yet")
        return
    middle, q1, median, q3 = quartiles(number[died], lifespan[died])
    axes.fill_between(middle, q1, q3, color=style.BLUE, alpha=0.25, linewidth=0)
    axes.plot(middle, median, color=style.BLUE)


def quartiles(number: np.ndarray, lifespan: np.ndarray) -> np.ndarray:
    """Return quartiles of lifespans in bins of birth order with equal numbers of dead.

    Returns:
        the middle of each bin, and its three quartiles, float64 (4, bins).
    """
    order = np.argsort(number, kind="stable")
    parts = np.array_split(order, np.clip(len(order) // ENOUGH, 1, BINS))
    return np.array(
        [(number[part].mean(), *np.percentile(lifespan[part], [25, 50, 75])) for part in parts]
    ).T
