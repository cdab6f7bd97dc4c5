"""Figures that compare runs: how long organisms live, and how soon worlds saturate."""

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

from primordia.comparison.comparison import ComparedArm, Comparison
from primordia.comparison.resample import LEAST
from primordia.figures import style

STOPPED = "|"
"""Mark of a world that stopped unsaturated, like the mark of censoring in survival curves."""
DASHES = "-", "--", ":"
MAX_COLUMNS = 3
"""Largest number of panels side by side."""
FEW_ARMS = 5
"""Largest number of runs that get colours from dark to light and a curve for each world."""
FEW_WORLDS = 200
"""Largest number of a run's worlds with separate curves."""


def save(compared: Comparison, folder: Path) -> list[Path]:
    """Write `compare.png` and `compare.svg`. Return their paths.

    Raises:
        Trouble: the files cannot be written.
    """
    with style.applied():
        return style.save(draw(compared), folder / "compare")


def draw(compared: Comparison) -> Figure:
    """Draw survival, how soon worlds saturate, and the food gathered if there is any.

    If few worlds saturate, the pace of dying is drawn in place of saturation.
    """
    panels = _panels(compared)
    rows, columns = (1, len(panels)) if len(panels) <= MAX_COLUMNS else (2, 2)
    figure = Figure(figsize=(style.PAGE, 2.7 * rows))
    widths = [1.6 if panel is _dying and columns == 2 else 1 for panel in panels[:columns]]
    all_axes = figure.subplots(rows, columns, width_ratios=widths, squeeze=False).flat
    for panel, axes in zip(panels, all_axes, strict=True):
        panel(axes, compared)
    _legend(figure, all_axes[0], compared)
    return figure


def _panels(compared: Comparison) -> list[Callable[[Axes, Comparison], None]]:
    """Return the functions that draw the panels."""
    saturation = [_saturated_by_births, _saturated_by_time]
    of_island = compared.island is not None  # then worlds' saturation is not compared
    middle = [_dying] if of_island or "pace" in compared.outcomes else saturation
    food = [_gathering] if "food" in compared.outcomes else []
    return [_alive, *middle, *food]


def line_styles(arms: int) -> list[dict[str, Any]]:
    """Return the line style of each run.

    The reference is black. If the other runs are few, their colours go from dark to light, in order.
    If they are many, their colours are distinct; when all colours are used, they begin again with
    dashed lines.
    """
    if arms > FEW_ARMS:
        lines = product(DASHES, [style.INK, *style.PALETTE, style.SOFT])
        return [{"color": colour, "linestyle": dash} for dash, colour in islice(cycle(lines), arms)]
    shades = matplotlib.colormaps["plasma"](np.linspace(0.25, 0.88, arms - 1))
    return [{"color": colour} for colour in (style.INK, *map(to_hex, shades))]


def _styled(compared: Comparison) -> Iterator[tuple[ComparedArm, dict[str, Any]]]:
    return zip(compared.arms, line_styles(len(compared.arms)), strict=True)


def _alive(axes: Axes, compared: Comparison) -> None:
    """Draw the Kaplan-Meier curve of each run; if the runs are few, with intervals if possible."""
    for arm, line in _styled(compared):
        survived = arm.survival
        ages, curve = np.maximum(survived.steps, 1), survived.with_ends(survived.curve)
        if len(compared.arms) <= FEW_ARMS and arm.worlds >= LEAST:
            low, high = map(survived.with_ends, survived.band)
            axes.fill_between(ages, low, high, step="post", color=line["color"], alpha=0.2, lw=0)
        axes.step(ages, curve, where="post", label=arm.name, **line)
    style.time_axis(axes, compared.age, "age (ticks)")
    born = "" if compared.island is None else f", born on {compared.island}"
    axes.set(title=f"Alive at each age{born}", ylabel="fraction of organisms", ylim=(-0.03, 1.03))


def _saturated_by_births(axes: Axes, compared: Comparison) -> None:
    _saturated(axes, compared, "births")
    axes.set(title="Saturated worlds by births", xlabel="births", ylabel="fraction of worlds")


def _saturated_by_time(axes: Axes, compared: Comparison) -> None:
    _saturated(axes, compared, "ticks")
    axes.set(title="Saturated worlds by time", xlabel="time (ticks)")


def _saturated(axes: Axes, compared: Comparison, unit: str) -> None:
    """Draw the share of worlds known to be saturated, and a mark where a world stopped unsaturated."""
    values = np.concatenate([arm.measured[unit].value for arm in compared.arms])
    power = 10 ** np.floor(np.log10(max(values.min(), 1)))
    first = power * (3 if values.min() >= 3 * power else 1)
    last = 1.2 * max(values.max(), first)
    for arm, line in _styled(compared):
        measured = arm.measured[unit]
        at = np.unique([first, *measured.value.clip(first), last])
        stopped = np.unique(measured.value[~measured.known])
        saturated = np.sort(measured.value[measured.known])
        share, share_at_stop = (
            np.searchsorted(saturated, each, side="right") / arm.worlds for each in (at, stopped)
        )
        axes.step(at, share, where="post", **line)
        axes.plot(stopped, share_at_stop, STOPPED, color=line["color"], markersize=4)
    style.logarithmic(axes.xaxis)
    if last / first < 100:  # too few powers of ten to read values
        axes.xaxis.set_major_locator(LogLocator(subs=(1, 3)))
    axes.set(xlim=(first, last), ylim=(-0.03, 1.03))


def _dying(axes: Axes, compared: Comparison) -> None:
    _over_time(axes, compared, lambda arm: arm.pace.curve)
    style.logarithmic(axes.yaxis)
    axes.set_title("Ticks lived for each death")


def _gathering(axes: Axes, compared: Comparison) -> None:
    _over_time(axes, compared, lambda arm: arm.gathering.curve)
    axes.set_title(f"Food gathered in a {compared.span}")


def _over_time(
    axes: Axes, compared: Comparison, curve: Callable[[ComparedArm], np.ndarray]
) -> None:
    """Draw the median of each run's curves (W, WINDOWS); if the worlds are few, also each curve."""
    most = max(arm.worlds for arm in compared.arms)
    few, edges = len(compared.arms) <= FEW_ARMS and most <= FEW_WORLDS, compared.arms[0].pace.edges
    middle = (edges[1:] + edges[:-1]) / 2
    for arm, line in _styled(compared):
        worlds = curve(arm)
        if few:
            axes.plot(middle, worlds.T, alpha=0.3, linewidth=0.8, **line)
        axes.plot(middle, np.median(worlds, axis=0), marker="o", markersize=3, **line)
    style.linear(axes.xaxis)
    axes.set(xlabel="time (ticks): worlds and median" if few else "time (ticks): median of worlds")
    axes.set_xlim(edges[0], edges[-1])


def _legend(figure: Figure, axes: Axes, compared: Comparison) -> None:
    """Draw the names of the runs, and the meaning of the marks if there are any."""
    handles = axes.get_legend_handles_labels()[0]
    known = [arm.measured["births"].known for arm in compared.arms]
    marked = _saturated_by_time in _panels(compared) and any(each.any() for each in known)
    if marked and not all(each.all() for each in known):
        handles.append(
            Line2D([], [], ls="", marker=STOPPED, color=style.SOFT, label="stopped unsaturated")
        )
    columns = min(len(handles), 4)
    figure.legend(handles=handles, loc="outside lower left", frameon=False, ncols=columns)
