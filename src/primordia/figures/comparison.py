"""Runs side by side: how long organisms live, and how soon worlds saturate."""

from itertools import cycle, islice
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from primordia.comparison import Arm, Comparison
from primordia.figures import style

STOPPED = "|"
"""Marks a world that stopped unsaturated, as censoring is marked in survival curves."""
FEW = 5
"""Up to so many runs are in an order of colours, and shown with how their worlds scatter."""


def save(compared: Comparison, folder: Path) -> list[Path]:
    """Write `compare.png` and `compare.svg` -> their paths.

    Raises:
        Trouble: they cannot be written.
    """
    with style.look():
        return style.save(draw(compared), folder / "compare")


def draw(compared: Comparison) -> Figure:
    """Survival of all lives, and how soon worlds saturate; where few do, how fast organisms die."""
    figure = Figure(figsize=(style.PAGE, 2.7))
    if "pace" not in compared.outcomes:
        alive, births, ticks = figure.subplots(1, 3)
        _saturated(births, compared, "births")
        births.set(title="Saturated, by births", xlabel="births", ylabel="fraction of worlds")
        _saturated(ticks, compared, "ticks")
        ticks.set(title="Saturated, by time", xlabel="time (ticks)")
    else:
        alive, dying = figure.subplots(1, 2, width_ratios=(1, 1.6))
        _dying(dying, compared)
    for arm, colour in zip(compared.arms, colours(len(compared.arms)), strict=True):
        _alive(alive, arm, colour, banded=len(compared.arms) <= FEW)
    style.time_axis(alive, compared.age, "age (ticks)")
    alive.set(title="Alive at each age", ylabel="fraction of organisms", ylim=(-0.03, 1.03))
    _legend(figure, alive, compared)
    return figure


def colours(arms: int) -> list[str]:
    """Ink for the reference; a few others in their order from dark to light; many, to be told apart."""
    if arms > FEW:
        return [*islice(cycle([style.INK, *style.PALETTE, style.SOFT]), arms)]
    shades = matplotlib.colormaps["plasma"](np.linspace(0.25, 0.88, max(arms - 1, 1)))
    return [style.INK, *(matplotlib.colors.to_hex(each) for each in shades[: arms - 1])]


def _alive(axes: Axes, arm: Arm, colour: str, banded: bool) -> None:
    """Kaplan-Meier of all lives, with a band over resamples of worlds."""
    survived = arm.survival
    ages = np.concatenate([[1], survived.ages, [survived.limit]])
    curve, low, high = (
        np.concatenate([[1.0], each, each[-1:]]) for each in (survived.curve, *survived.band)
    )
    if banded:
        axes.fill_between(ages, low, high, step="post", color=colour, alpha=0.2, linewidth=0)
    axes.step(ages, curve, where="post", color=colour, label=arm.name)


def _saturated(axes: Axes, compared: Comparison, unit: str) -> None:
    """Share of worlds known to be saturated; marks where worlds stopped that were not."""
    values = np.concatenate([arm.figures[unit].value for arm in compared.arms])
    power = 10 ** np.floor(np.log10(max(values.min(), 1)))
    first = power * (3 if values.min() >= 3 * power else 1)
    last = 1.2 * values.max()
    for arm, colour in zip(compared.arms, colours(len(compared.arms)), strict=True):
        figures = arm.figures[unit]
        at = np.concatenate([[first], np.unique(figures.value), [last]])
        stopped = np.unique(figures.value[~figures.known])
        saturated = np.sort(figures.value[figures.known])
        share, left = (
            np.searchsorted(saturated, each, side="right") / arm.worlds for each in (at, stopped)
        )
        axes.step(at, share, where="post", color=colour)
        axes.plot(stopped, left, STOPPED, color=colour, markersize=4)
    style.logarithmic(axes.xaxis)
    if last / first < 100:  # too few powers of ten to read a value off
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 3)))
    axes.set(xlim=(first, last), ylim=(-0.03, 1.03))


def _dying(axes: Axes, compared: Comparison) -> None:
    """Ticks lived for each death as time goes on: every world of a few runs, and the median."""
    few = len(compared.arms) <= FEW
    for arm, colour in zip(compared.arms, colours(len(compared.arms)), strict=True):
        middle = (arm.pace.edges[1:] + arm.pace.edges[:-1]) / 2
        for world in arm.pace.curve if few else ():
            axes.plot(middle, world, color=colour, alpha=0.3, linewidth=0.8)
        axes.plot(middle, np.median(arm.pace.curve, axis=0), "o-", color=colour, markersize=3)
    style.counted(axes.xaxis)
    style.logarithmic(axes.yaxis)
    shown = "worlds and median" if few else "median of worlds"
    axes.set(title=f"Ticks lived for each death: {shown}", xlabel="time (ticks)")
    axes.set(xlim=(0, arm.pace.edges[-1]))


def _legend(figure: Figure, axes: Axes, compared: Comparison) -> None:
    """Names of the runs, and what the marks are if there are any."""
    handles = axes.get_legend_handles_labels()[0]
    known = [arm.figures["births"].known for arm in compared.arms]
    marked = "pace" not in compared.outcomes and any(each.any() for each in known)
    if marked and not all(each.all() for each in known):
        handles.append(
            Line2D([], [], ls="", marker=STOPPED, color=style.SOFT, label="stopped unsaturated")
        )
    columns = min(len(handles), 4)
    figure.legend(handles=handles, loc="outside lower left", frameon=False, ncols=columns)
