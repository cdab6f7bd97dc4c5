"""The style of figures: widths of a paper's columns, colours for the colour-blind, and saving."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from primordia import files
from primordia.history import series
from primordia.runs.lives import Lives

COLUMN, PAGE = 3.4, 7.0
"""Widths in inches."""
LINE, LETTER, GAP = 9, 4.2, 6
"""Height of a line of a key, mean width of its letters, and space between its words, in points."""

INK, SOFT, FAINT = "#222222", "#6b6b6b", "#d4d4d4"
ORANGE, SKY, GREEN, YELLOW = "#e69f00", "#56b4e9", "#009e73", "#f0e442"
BLUE, VERMILION, PURPLE = "#0072b2", "#d55e00", "#cc79a7"
PALETTE = BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY, YELLOW
"""The palette of Okabe and Ito (2008)."""
ISLANDS = PALETTE[:-1]
"""Colours of few islands, without yellow, in which words are hard to read."""

PARAMETERS: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 7,
    "axes.titlesize": 8,
    "axes.titlelocation": "left",
    "axes.titlecolor": INK,
    "axes.labelsize": 7,
    "axes.labelcolor": INK,
    "axes.edgecolor": SOFT,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "text.color": INK,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.2,
    "lines.solid_capstyle": "butt",
    "figure.dpi": 300,
    "savefig.dpi": 300,
    "figure.constrained_layout.use": True,
    "svg.fonttype": "none",
    "svg.hashsalt": "primordia",
}


@contextmanager
def applied() -> Iterator[None]:
    """Draw and save the figures of a `with` block in this style, independent of the user's settings."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(PARAMETERS)
        yield


def save(figure: Figure, stem: Path) -> list[Path]:
    """Write a figure as PNG and SVG, with the same bytes each time. Return the two paths.

    Raises:
        Trouble: a file cannot be written.
    """
    paths = [stem.with_suffix(".png"), stem.with_suffix(".svg")]
    for path, metadata in zip(paths, ({}, {"Date": None}), strict=True):
        files.write(path, partial(figure.savefig, format=path.suffix[1:], metadata=metadata))
    return paths


def time_label(lives: Lives) -> str:
    """Return the label of a time axis; `lives` are from `Lives.since_fork`."""
    return "time since the fork (ticks)" if (lives.entered > 0).any() else "time (ticks)"


def time_axis(axes: Axes, last: int, label: str) -> None:
    """Make the x axis logarithmic, from tick 1 to `last`, since most events are early."""
    logarithmic(axes.xaxis)
    axes.set_xlim(1, max(last, 10))
    axes.set_xlabel(label)


def logarithmic(axis: Any) -> None:
    """Make an axis logarithmic, in whole powers of ten around the data, written 1, 10, 100, 1k, ..."""
    low, high = axis.get_data_interval()
    if not 0 < low <= high < np.inf:
        low, high = 1, 1  # nothing to show
    floor, ceiling = np.floor(np.log10(low)), np.ceil(np.log10(high))
    limits = 10**floor, 10 ** max(ceiling, floor + 1)
    axis.axes.set(**{f"{axis.axis_name}lim": limits})
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_locator(LogLocator(numticks=9))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: short(value)))


def linear(axis: Any) -> None:
    """Write the numbers of a linear axis as 500, 1k, 1.5k, ..."""
    axis.set_major_formatter(FuncFormatter(lambda value, _: short(value)))


def short(value: float) -> str:
    """Write a number in few characters: 500, 1.5k, 2M, 0.5; below 0.1 as 1/100."""
    if 0 < value < 0.1:
        return f"1/{short(round(1 / value))}"
    for size, unit in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if float(f"{value:.3g}") >= size:
            return f"{value / size:.3g}{unit}"
    return f"{value:g}"


def curves(axes: Axes, x: np.ndarray, ys: np.ndarray, colour: str = BLUE) -> None:
    """Draw a curve for each world, with gaps at NaN; `ys` is (W, X).

    The curves of several worlds are faint, behind median and quartiles. Median and quartiles end
    when fewer than half of the worlds have a value.
    """
    if len(ys) == 1:
        axes.plot(x, ys[0], color=colour)
        return
    axes.plot(x, ys.T, color=colour, linewidth=0.4, alpha=min(0.3, 6 / len(ys)))
    quartiles = series.spread(ys)
    axes.fill_between(x, quartiles[0], quartiles[2], color=colour, alpha=0.25, linewidth=0)
    axes.plot(x, quartiles[1], color=colour)


def title(axes: Axes, text: str, key: dict[str, str] | None = None, above: int = 0) -> None:
    """Write the title of a panel, and below it a key: words in the colours of the things they name.

    `above` are points that stay free between the panel and the key.
    """
    lines = _lines(axes, key or {})
    height = 4 + above + LINE * len(lines)
    axes.set_title(text, pad=height)
    for line in lines:
        height -= LINE
        place: dict[str, Any] = {"xy": (0, 1), "xytext": (0, height), "xycoords": axes.transAxes}
        for word, colour in line.items():
            put = axes.annotate(word, **place, textcoords="offset points", color=colour)
            place = {"xy": (1, 0), "xytext": (GAP, 0), "xycoords": put, "va": "bottom"}


def _lines(axes: Axes, key: dict[str, str]) -> list[dict[str, str]]:
    """Return a key in lines that are not wider than the panel; a longer one would crush the panels."""
    grid, figure = axes.get_subplotspec(), axes.get_figure(root=True)
    assert figure is not None
    columns = 1 if grid is None else grid.get_gridspec().ncols
    room, lines = 0.85 * 72 * figure.get_figwidth() / columns, [dict[str, str]()]
    for word, colour in key.items():
        if lines[-1] and sum(GAP + LETTER * len(each) for each in [*lines[-1], word]) > room:
            lines.append({})
        lines[-1][word] = colour
    return lines


def worlds_key(count: int) -> dict[str, str]:
    """Return the key of a panel drawn by `curves`; it is empty for one world."""
    return {f"median and quartiles of {count} worlds": BLUE} if count > 1 else {}


def pooled_key(count: int) -> dict[str, str]:
    """Return the key of a panel that shows several worlds together; it is empty for one world."""
    return {f"{count} worlds together": SOFT} if count > 1 else {}


def island_colours(names: Sequence[str]) -> dict[str, str]:
    """Return a colour for each island; many islands have a darkened rainbow, in their order."""
    if len(names) <= len(ISLANDS):
        return dict(zip(names, ISLANDS, strict=False))
    scale = 0.85 * matplotlib.colormaps["turbo"](np.linspace(0.03, 0.97, len(names)))[:, :3]
    return {name: to_hex(colour) for name, colour in zip(names, scale, strict=True)}


def remark(axes: Axes, text: str) -> None:
    """Write a remark in the middle of an empty panel."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=SOFT)
