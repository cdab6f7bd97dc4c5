"""Figures of the assays of islands: transplants and generalists."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

from primordia.assays.generalists import Generalists
from primordia.assays.transplant import FOUNDERS, Transplant
from primordia.figures import style

LIGHT = 0.58
"""Luminance of a cell of a heat map above which its number is dark."""
WORDS = 36
"""Most letters of the names of all islands that stand below a heat map without being turned."""
WORLDS = 6
"""Largest number of worlds whose generalists are drawn."""


def transplant(found: list[Transplant]) -> Figure:
    """Draw the median life of each island's natives on each island, and local lives against foreign.

    Homes have frames. In the second panel there is a dot for each world.
    """
    islands = found[0].islands
    figure = Figure(figsize=(style.PAGE, 1.5 + 0.32 * (len(islands) + 1)))
    heat, ratios = figure.subplots(1, 2, width_ratios=(1.25, 1))
    _heat(heat, islands, _medians(np.array([each.lived for each in found])), len(found))
    _ratio_axis(ratios, [each for one in found for each in (one.home_away, one.local_foreign)])
    compared = {"home / away": style.SKY, "local / foreign": style.BLUE}
    _ratios(ratios, islands, [each.home_away for each in found], -1, compared["home / away"])
    _ratios(ratios, islands, [each.local_foreign for each in found], 1, compared["local / foreign"])
    ratios.axvline(1, color=style.SOFT, linewidth=0.8, zorder=0)
    ratios.set_yticks(range(len(islands)), islands)
    ratios.set(ylim=(len(islands) - 0.5, -0.5), xlabel="ratio of lives")
    ratios.tick_params(axis="y", length=0)
    ratios.spines["left"].set_visible(False)
    style.title(ratios, "Are natives adapted to their home?", compared)
    return figure


def _medians(lived: np.ndarray) -> np.ndarray:
    """Return the median of the worlds (W, ...) in which a value is known; NaN if there is none."""
    known = np.isfinite(lived).any(axis=0)
    found = np.full(lived.shape[1:], np.nan)
    found[known] = np.nanmedian(lived[:, known], axis=0)
    return found


def _heat(axes: Axes, islands: tuple[str, ...], lived: np.ndarray, worlds: int) -> None:
    """Draw lives (K + 1, K) as colours and numbers."""
    known = lived[np.isfinite(lived)]
    norm = LogNorm(max(known.min(), 1), max(known.max(), 1) * 1.001)
    image = axes.imshow(np.maximum(lived, 1), norm=norm, cmap="cividis", aspect="auto")
    for (row, column), value in np.ndenumerate(lived):
        red, green, blue, _ = image.cmap(norm(max(value, 1)))
        light = 0.3 * red + 0.59 * green + 0.11 * blue
        axes.text(
            column, row, f"{value:,.0f}" if np.isfinite(value) else "-", ha="center", va="center",
            color=style.INK if light > LIGHT else "white",
        )  # fmt: skip
    for k in range(len(islands)):
        home = Rectangle((k - 0.47, k - 0.45), 0.94, 0.9, fill=False, edgecolor=style.VERMILION)
        axes.add_patch(home)
        home.set_linewidth(1.4)
    axes.axhline(len(islands) - 0.5, color="white", linewidth=2.4)
    axes.set_xticks(range(len(islands)), islands)
    if len("".join(islands)) > WORDS:
        axes.tick_params(axis="x", labelrotation=30)
        for label in axes.get_xticklabels():
            label.set_horizontalalignment("right")
    axes.set_yticks(range(len(islands) + 1), [*islands, FOUNDERS])
    axes.tick_params(length=0)
    axes.set(xlabel="island on which they live", ylabel="island of birth")
    axes.spines[:].set_visible(False)
    over = f", median of {worlds} worlds" if worlds > 1 else ""
    style.title(axes, f"Ticks lived{over}", {"framed: at home": style.VERMILION})


def _ratios(
    axes: Axes, islands: tuple[str, ...], values: list[np.ndarray], side: int, colour: str
) -> None:
    """Draw each island's ratios of all worlds on one side of the island's line, with their median."""
    for k, each in enumerate(np.array(values).T):
        known = each[np.isfinite(each) & (each > 0)]
        if not len(known):
            continue
        place = k + 0.17 * side
        if len(known) > 1:
            spread = place + np.linspace(-0.1, 0.1, len(known))
            axes.plot(known, spread, ".", color=colour, markersize=4, alpha=0.6, markeredgewidth=0)
        axes.plot(np.median(known), place, "d", color=colour, markersize=5, markeredgewidth=0)


def _ratio_axis(axes: Axes, ratios: list[np.ndarray]) -> None:
    """Make the x axis logarithmic around 1, with room for all ratios."""
    values = np.concatenate(ratios)
    known = np.abs(np.log(values[np.isfinite(values) & (values > 0)]))
    furthest = 1.15 * float(np.exp(max(known.max(initial=0), np.log(2))))
    axes.set(xscale="log", xlim=(1 / furthest, furthest))
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if furthest < 20 else (1,)))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def generalists(found: list[Generalists]) -> Figure:
    """Draw how many islands late organisms master, and the lives on the line of the most general one.

    There is a row for each of the first worlds.
    """
    shown = found[:WORLDS]
    figure = Figure(figsize=(style.PAGE, 2.5 * len(shown)))
    rows = figure.subplots(len(shown), 2, squeeze=False, width_ratios=(1, 2.2))
    for (shares, line), each in zip(rows, shown, strict=True):
        where = f", world {each.world}" if len(found) > 1 else ""
        _shares(shares, each, where)
        _line(line, each, where)
    return figure


def _shares(axes: Axes, found: Generalists, where: str) -> None:
    """Draw the share of organisms that master 0 to K islands, by their island of birth."""
    colours = style.island_colours(found.islands)
    counts, bottom = np.arange(len(found.islands) + 1), np.zeros(len(found.islands) + 1)
    for k, colour in enumerate(colours.values()):
        own = np.bincount(found.mastered[found.home == k], minlength=len(counts))
        share = own / len(found.organism)
        axes.bar(counts, share, 0.7, bottom, color=colour)
        bottom += share
    axes.set_xticks(counts)
    axes.set(xlabel="islands that an organism masters", ylabel="share of late organisms")
    axes.set_ylim(0, max(1.12 * bottom.max(), 0.1))
    style.title(axes, f"Late organisms{where}, born on", colours)


def _line(axes: Axes, found: Generalists, where: str) -> None:
    """Draw the life on each island over the generations of a line.

    A dashed line is the best founder. A dot is the ancestor from which on the line masters an island.
    """
    colours = style.island_colours(found.islands)
    generation = [each.generation for each in found.line]
    gains = {island: gained for gained, island in found.gains}
    for k, (island, colour) in enumerate(colours.items()):
        lived = [max(each.lived[k], 1) for each in found.line]
        axes.plot(generation, lived, color=colour)
        best = max(found.best_founder[k], 1)
        axes.axhline(best, color=colour, linewidth=0.6, linestyle=(0, (4, 3)), alpha=0.7, zorder=0)
        if (gained := gains.get(island)) is not None:
            axes.plot(
                gained.generation, max(gained.lived[k], 1), "o", color=colour, markersize=6,
                zorder=4, markeredgecolor="white", markeredgewidth=0.8,
            )  # fmt: skip
    style.logarithmic(axes.yaxis)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    last = found.line[-1]
    axes.set(xlabel="generation", ylabel="ticks lived", xlim=(0, max(last.generation, 1) * 1.02))
    key = {**colours, "dashed: the best founder;  dot: masters the island from here on": style.SOFT}
    style.title(axes, f"The line of organism {last.organism:,}{where}, living on", key)
