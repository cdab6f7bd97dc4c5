"""The figure of a line of descent: lives, mutations, and shares of some ancestors' descendants."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history import series
from primordia.phylogeny.descent import Ancestors

CURVES = 7
"""Largest number of ancestors whose descendants are drawn."""


def draw(found: Ancestors) -> Figure:
    """Draw lifespans and sizes of mutations by tick of birth, and shares of the living over time."""
    figure = Figure(figsize=(style.PAGE, 6.2))
    lives, changes, shares = figure.subplots(3, sharex=True)
    _lives(lives, found)
    _changes(changes, found)
    _shares(shares, found)
    for axes in (lives, changes, shares):
        style.linear(axes.xaxis)
    shares.set(xlabel="time (ticks)", xlim=(found.census.ticks[0], None))
    return figure


def _lives(axes: Axes, found: Ancestors) -> None:
    line = found.line
    for which, colour in ((line.died, style.BLUE), (~line.died, style.ORANGE)):
        axes.plot(
            line.born[which], np.maximum(line.lifespan[which], 1), ".", color=colour,
            markersize=4, markeredgewidth=0,
        )  # fmt: skip
    style.logarithmic(axes.yaxis)
    axes.set_ylabel("ticks lived")
    key = {"dead": style.BLUE, "alive": style.ORANGE}
    style.title(axes, f"The ancestors of organism {found.organism} of world {found.world}", key)


def _changes(axes: Axes, found: Ancestors) -> None:
    """Draw the size of each mutation in each block."""
    colours = [style.PALETTE[k % len(style.PALETTE)] for k in range(len(found.blocks))]
    if found.changes is None or not np.isfinite(found.changes).any():
        style.remark(axes, "mutations are unknown")
        style.title(axes, "Size of mutations")
        return
    for block, colour in zip(found.changes.T, colours, strict=True):
        axes.plot(found.line.born, block, ".", color=colour, markersize=3, markeredgewidth=0)
    axes.set_ylim(0, None)
    axes.set_ylabel("L2 norm of the change")
    key = dict(zip(found.blocks, colours, strict=True)) if len(found.blocks) <= 6 else {}
    style.title(axes, "Size of mutations, by block of weights", key)


def _shares(axes: Axes, found: Ancestors) -> None:
    """Draw the share of the living that descends from each of some ancestors, since its birth."""
    places = series.places(len(found.line), CURVES)
    ticks, shares = found.census.ticks, found.shares(places)
    key = {}
    for number, (place, share) in enumerate(zip(places, shares.T, strict=True)):
        colour = style.PALETTE[number % len(style.PALETTE)]
        born = found.line.born[place]
        axes.plot(ticks[ticks >= born], share[ticks >= born], color=colour)
        key[f"{found.line.id[place]}"] = colour
    axes.set(ylim=(0, 1.02), ylabel="share of the living")
    style.title(axes, "Descendants of some ancestors, the oldest first", key)
