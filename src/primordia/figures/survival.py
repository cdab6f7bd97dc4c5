"""Survival by cohort of birth, and the risk of death by age and over time."""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.comparison.survival import survival
from primordia.figures import style
from primordia.history import series
from primordia.runs.lives import Lives
from primordia.runs.records import Records

COHORTS = {
    "first quarter": "#d89000",
    "second quarter": "#cc4f39",
    "third quarter": "#8f2d75",
    "last quarter": "#2a2f86",
}
"""Quarters of a world's births in order, with colours from light to dark."""


def draw(run: Records, world: int) -> Figure:
    """Draw survival with a table of numbers at risk, and risks of death; all worlds are pooled."""
    lives = run.lives.since_fork()
    figure = Figure(figsize=(style.PAGE, 2.8))
    alive, by_age, over_time = figure.subplots(1, 3)
    _alive(alive, lives)
    _by_age(by_age, lives)
    _over_time(over_time, lives)
    for axes in (by_age, over_time):
        style.logarithmic(axes.yaxis)
        axes.set_ylabel("deaths per tick lived")
        if not lives.died.any():
            axes.set_yticks([])
            style.remark(axes, "no deaths yet")
    return figure


def quarters(lives: Lives) -> list[Lives]:
    """Return the lives of each quarter of births; each world's births so far are divided separately."""
    births = np.bincount(lives.world)[lives.world]
    quarter = lives.rank * len(COHORTS) // births
    return [lives.take(quarter == number) for number in range(len(COHORTS))]


def alive_at(cohort: Lives, longest: int) -> tuple[np.ndarray, np.ndarray]:
    """Return ages up to the longest, and the share alive after each (Kaplan-Meier), all worlds
    together."""
    pooled = replace(cohort, world=np.zeros_like(cohort.world))
    survived = survival(pooled, 1, longest)
    return survived.steps, survived.with_ends(survived.curve)


def hazard(start: np.ndarray, stop: np.ndarray, died: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Return deaths per tick lived in each bin of age or time, float64; NaN for bins with too few
    deaths."""
    return series.per_tick(stop[died], series.exposure(start, stop, edges), edges)


def _alive(axes: Axes, lives: Lives) -> None:
    longest = int(lives.lifespan.max())
    cohorts = quarters(lives)
    for cohort, colour in zip(cohorts, COHORTS.values(), strict=True):
        if len(cohort):
            axes.step(*alive_at(cohort, longest), where="post", color=colour)
    style.time_axis(axes, longest, "age (ticks)")
    style.title(axes, "Alive at each age", style.pooled_key(lives.worlds))
    axes.set(ylabel="fraction alive", ylim=(0, 1.02))
    _at_risk(axes, cohorts)


def _at_risk(axes: Axes, cohorts: list[Lives]) -> None:
    """Write, below the axis, how many of each cohort are at risk at each labelled age."""

    def write(x: float, line: int, text: str, colour: str, align: str) -> None:
        axes.annotate(
            text, (x, 0), (0, -26 - 8 * line), xycoords=axes.get_xaxis_transform(),
            textcoords="offset points", fontsize=6, ha=align, va="top", color=colour,
        )  # fmt: skip

    powers = int(np.log10(axes.get_xlim()[1])) + 1
    write(0.3, 0, "at risk, born in the", style.SOFT, "right")
    for line, (cohort, (name, colour)) in enumerate(zip(cohorts, COHORTS.items(), strict=True), 1):
        write(0.3, line, name, colour, "right")
        for age in (10**power for power in range(powers)):
            at_risk = int(((cohort.lifespan >= age) & (cohort.entered < age)).sum())
            write(age, line, style.short(at_risk), colour, "center")


def _by_age(axes: Axes, lives: Lives) -> None:
    longest = int(lives.lifespan.max())
    edges = series.bins(longest)
    for cohort, colour in zip(quarters(lives), COHORTS.values(), strict=True):
        risk = hazard(cohort.entered, cohort.lifespan, cohort.died, edges)
        axes.plot(series.middle(edges), risk, ".-", color=colour, markersize=3)
    style.time_axis(axes, longest, "age (ticks)")
    style.title(axes, "Risk of death by age", style.pooled_key(lives.worlds))


def _over_time(axes: Axes, lives: Lives) -> None:
    last = int(lives.ended.max())
    edges = series.bins(last)
    risk = hazard(lives.seen, lives.ended, lives.died, edges)
    axes.plot(series.middle(edges), risk, ".-", color=style.INK, markersize=3)
    style.time_axis(axes, last, style.time_label(lives))
    style.title(axes, "Risk of death over time", style.pooled_key(lives.worlds))
