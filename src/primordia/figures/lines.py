"""Lines of one world: their shares, their number compared with drift, and the tree of the living."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.phylogeny.lines import BAND, WorldLines

COLOURED = len(style.PALETTE)
"""Largest number of lines with a separate colour."""
DRAWN = 60
"""Largest number of lines that are drawn."""
SHADOWS = "95 % of neutral shadows"


def draw(found: WorldLines) -> Figure:
    """Draw the lines of a world; time runs from the tick at which they were founded."""
    figure = Figure(figsize=(style.PAGE, 5.2))
    (shares, effective), (diversity, pairs) = figure.subplots(2, 2)
    _shares(shares, found)
    _effective(effective, found)
    _diversity(diversity, found)
    _pairs(pairs, found)
    for axes in (shares, effective, diversity):
        style.time_axis(axes, int(_time(found)[-1]), "time since lines were founded (ticks)")
    return figure


def _time(found: WorldLines) -> np.ndarray:
    """Return the time of each instant. The first instant is at 1, since the axis is logarithmic."""
    return np.maximum(found.ticks - found.ticks[0], 1)


def _shares(axes: Axes, found: WorldLines) -> None:
    low, high = np.percentile(found.drift.largest, BAND, axis=0)
    axes.fill_between(_time(found), low, high, color=style.FAINT, linewidth=0)
    order = found.ranked
    axes.plot(_time(found), found.shares[:, order[COLOURED:DRAWN]], color=style.SOFT, linewidth=0.4)
    for place, colour in zip(
        order[:COLOURED][::-1], style.PALETTE[: len(order)][::-1], strict=True
    ):
        axes.plot(_time(found), found.shares[:, place], color=colour)
    axes.set(ylim=(0, 1.02), ylabel="share of the living")
    named = zip(order[:4].tolist(), style.PALETTE, strict=False)
    key = {f"line of {found.lives.id[found.founders[place]]}": colour for place, colour in named}
    key[f"{SHADOWS}: largest line"] = style.SOFT
    style.title(axes, f"{len(order):,} lines of world {found.world}", key)


def _effective(axes: Axes, found: WorldLines) -> None:
    low, high = np.percentile(found.drift.effective, BAND, axis=0)
    band = np.maximum(low, 1), np.maximum(high, 1)  # an extinct world has no line left
    axes.fill_between(_time(found), *band, color=style.FAINT, linewidth=0)
    some = found.effective[2] > 0
    axes.plot(_time(found)[some], found.effective[2, some], color=style.BLUE)
    style.logarithmic(axes.yaxis)
    axes.set_ylabel("lines")
    style.title(axes, "Effective number of lines", {"recorded": style.BLUE, SHADOWS: style.SOFT})


def _diversity(axes: Axes, found: WorldLines) -> None:
    axes.plot(_time(found), found.diversity, color=style.BLUE)
    fixed = [each.fixed for each in found.sweeps if each.fixed is not None]
    late = [tick for tick in fixed if tick > found.ticks[0]]
    for sweep in late:
        axes.axvline(sweep - found.ticks[0], color=style.ORANGE, linewidth=0.6, zorder=0)
    axes.set_ylim(0, None)
    style.linear(axes.yaxis)
    axes.set_ylabel("total length of branches (ticks)")
    key = {"a new common ancestor": style.ORANGE} if late else {}
    style.title(axes, "Phylogenetic diversity of the living", key)


def _pairs(axes: Axes, found: WorldLines) -> None:
    for times, colour in ((found.neutral_pairs, style.SOFT), (found.pairs, style.BLUE)):
        axes.step(np.append(0, times.back), np.append(0, times.share), where="post", color=colour)
    if not len(found.pairs.back):
        style.remark(axes, "no two of the living have a common ancestor on record")
    last = max(int(found.ticks[-1] - found.lives.born.min()), 1)
    axes.set(ylim=(0, 1.02), xlim=(0, last), ylabel="share of pairs")
    style.linear(axes.xaxis)
    axes.set_xlabel("ticks back to the common ancestor of a pair")
    key = {"recorded": style.BLUE, "expected from drift": style.SOFT}
    style.title(axes, "Coalescence of pairs of the living", key)
