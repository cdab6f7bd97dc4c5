"""Runs side by side: how long organisms live, and how soon worlds saturate."""

from collections.abc import Callable, Iterator
from itertools import cycle, islice, product
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator

from primordia.comparison.comparison import Arm, Comparison
from primordia.figures import style

STOPPED = "|"
"""Marks a world that stopped unsaturated, as censoring is marked in survival curves."""
DASHES = "-", "--", ":"
MOST = 3
"""Panels that have room side by side."""
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
    """Survival of all lives, and how soon worlds saturate or, where few do, how fast organisms die; what
    they gather, where there is food.
    """
    panels: list[Callable[[Axes, Comparison], None]] = [_alive]
    panels += (
        [_dying] if "pace" in compared.outcomes else [_saturated_by_births, _saturated_by_time]
    )
    panels += [_gathering] * ("food" in compared.outcomes)
    rows, columns = (1, len(panels)) if len(panels) <= MOST else (2, 2)
    figure = Figure(figsize=(style.PAGE, 2.7 * rows))
    widths = [1.6 if panel is _dying and columns == 2 else 1 for panel in panels[:columns]]
    all_axes = figure.subplots(rows, columns, width_ratios=widths, squeeze=False).flat
    for panel, axes in zip(panels, all_axes, strict=True):
        panel(axes, compared)
    _legend(figure, all_axes[0], compared)
    return figure


def looks(arms: int) -> list[dict[str, Any]]:
    """How each run's lines look. The reference is in ink, a few others in their order from dark to light;
    many are to be told apart, by dashes where colours begin again.
    """
    if arms > FEW:
        lines = product(DASHES, [style.INK, *style.PALETTE, style.SOFT])
        return [{"color": colour, "linestyle": dash} for dash, colour in islice(cycle(lines), arms)]
    shades = matplotlib.colormaps["plasma"](np.linspace(0.25, 0.88, max(arms - 1, 1)))
    return [{"color": each} for each in (style.INK, *map(to_hex, shades[: arms - 1]))]


def _looking(compared: Comparison) -> Iterator[tuple[Arm, dict[str, Any]]]:
    return zip(compared.arms, looks(len(compared.arms)), strict=True)


def _alive(axes: Axes, compared: Comparison) -> None:
    """Kaplan-Meier of all lives; those of a few runs with a band over resamples of worlds."""
    for arm, look in _looking(compared):
        survived = arm.survival
        ages = np.maximum(survived.steps, 1)
        curve, low, high = map(survived.whole, (survived.curve, *survived.band))
        if len(compared.arms) <= FEW:
            axes.fill_between(ages, low, high, step="post", color=look["color"], alpha=0.2, lw=0)
        axes.step(ages, curve, where="post", label=arm.name, **look)
    style.time_axis(axes, compared.age, "age (ticks)")
    axes.set(title="Alive at each age", ylabel="fraction of organisms", ylim=(-0.03, 1.03))


def _saturated_by_births(axes: Axes, compared: Comparison) -> None:
    _saturated(axes, compared, "births")
    axes.set(title="Saturated, by births", xlabel="births", ylabel="fraction of worlds")


def _saturated_by_time(axes: Axes, compared: Comparison) -> None:
    _saturated(axes, compared, "ticks")
    axes.set(title="Saturated, by time", xlabel="time (ticks)")


def _saturated(axes: Axes, compared: Comparison, unit: str) -> None:
    """Share of worlds known to be saturated; marks where worlds stopped that were not."""
    values = np.concatenate([arm.figures[unit].value for arm in compared.arms])
    power = 10 ** np.floor(np.log10(max(values.min(), 1)))
    first = power * (3 if values.min() >= 3 * power else 1)
    last = 1.2 * values.max()
    for arm, look in _looking(compared):
        figures = arm.figures[unit]
        at = np.concatenate([[first], np.unique(figures.value), [last]])
        stopped = np.unique(figures.value[~figures.known])
        saturated = np.sort(figures.value[figures.known])
        share, left = (
            np.searchsorted(saturated, each, side="right") / arm.worlds for each in (at, stopped)
        )
        axes.step(at, share, where="post", **look)
        axes.plot(stopped, left, STOPPED, color=look["color"], markersize=4)
    style.logarithmic(axes.xaxis)
    if last / first < 100:  # too few powers of ten to read a value off
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 3)))
    axes.set(xlim=(first, last), ylim=(-0.03, 1.03))


def _dying(axes: Axes, compared: Comparison) -> None:
    _over_time(axes, compared, lambda arm: arm.pace.curve)
    style.logarithmic(axes.yaxis)
    axes.set_title("Ticks lived for each death")


def _gathering(axes: Axes, compared: Comparison) -> None:
    _over_time(axes, compared, lambda arm: arm.gathering.curve)
    axes.set_title(f"Food gathered in a {compared.span}")


def _over_time(axes: Axes, compared: Comparison, curve: Callable[[Arm], np.ndarray]) -> None:
    """Curves (W, WINDOWS): every world of a few runs, and the median."""
    few, edges = len(compared.arms) <= FEW, compared.arms[0].pace.edges
    middle = (edges[1:] + edges[:-1]) / 2
    for arm, look in _looking(compared):
        worlds = curve(arm)
        if few:
            axes.plot(middle, worlds.T, alpha=0.3, linewidth=0.8, **look)
        axes.plot(middle, np.median(worlds, axis=0), marker="o", markersize=3, **look)
    style.counted(axes.xaxis)
    axes.set(xlabel="time (ticks): worlds and median" if few else "time (ticks): median of worlds")
    axes.set_xlim(edges[0], edges[-1])


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
