"""The lines of descent of one world in space and time: cells across, births downwards."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter

from primordia.config import Config
from primordia.figures import style
from primordia.history import series
from primordia.history.traits import factors_of
from primordia.phylogeny.clades import Clades, clades_of, crowd_size
from primordia.runs.lives import Lives
from primordia.runs.records import Records
from primordia.settings.islands import Islands

ROWS, COLUMNS = 800, 512
"""Largest numbers of moments and of cells that are drawn. If there are more, evenly
spaced ones are drawn."""
EMPTY = -1
"""Mark of an empty cell, in place of the row of an organism."""
HUES = (
    style.BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.SKY, style.VERMILION, style.YELLOW,
)  # fmt: skip
STRONG = np.concatenate([share * np.array([to_rgb(hue) for hue in HUES]) for share in (1, 0.6)])
YOUNG = "#a0a0a0"
PALE = 0.7
"""Share of white in the colour of a line that died out."""
COLOURS = np.concatenate([STRONG, [to_rgb(YOUNG)]])
INKS = np.concatenate([COLOURS, 1 - (1 - COLOURS) * (1 - PALE)])
"""All colours of lines, float64 (30, 3): the strong ones, then the pale ones in the same order."""
NAMES = 8
"""Points above the picture for the names of islands."""
MAX_TAKEOVERS = 8
"""Largest number of takeovers with a mark."""
TRAITS, MOMENTS = 3, 200
"""Largest numbers of traits that are drawn, and of moments; each organism's genome is made again."""


def draw(run: Records, world: int) -> Figure:
    """Draw one world. The unit of time is births, since little happens in most ticks of a
    long-lived world. If bodies are inherited, the same cells are drawn in the colours of traits."""
    here, config = run.lives.of_world(world), run.config
    names = config.traits.names[:TRAITS] if config.traits else ()
    figure = Figure(figsize=(style.COLUMN * (1 + len(names)), 4.8))
    axes, *others = figure.subplots(1, 1 + len(names), squeeze=False)[0]
    births = series.places(len(here), ROWS)
    cells = np.arange(0, config.cells, -(-config.cells // COLUMNS))
    clades, ticks = clades_of(here), here.born[births]
    extent = (-0.5, config.cells - 0.5, len(here) + 0.5, 0.5)
    shown: dict[str, Any] = {"aspect": "auto", "interpolation": "nearest", "extent": extent}
    axes.imshow(picture(here, clades, cells, ticks), **shown)
    _label(axes, config, world, len(cells))
    if config.islands.count > 1:
        _mark_islands(axes, config.islands)
    _time_axis(axes, here)
    _mark_renewals(axes, here, clades)
    if names:
        factors = _factors(run, world, occupants(here, cells, ticks[:: -(-len(ticks) // MOMENTS)]))
        for panel, name, values in zip(others, names, factors, strict=False):
            panel.set_axis_off()
            if np.isnan(values).all():
                continue
            colours = panel.imshow(values, cmap="viridis", norm=LogNorm(), **shown)
            style.title(panel, name, {"factor of the habitat's own body": style.SOFT})
            bar = figure.colorbar(colours, ax=panel, format="%.3g")
            least, most = colours.get_clim()
            bar.set_ticks(np.geomspace(least, most, 5).tolist())
            bar.minorticks_off()
    return figure


def _factors(run: Records, world: int, rows: np.ndarray) -> np.ndarray:
    """Return the traits of the organisms in a picture, float64 (traits, T, N); NaN in empty cells.

    `rows` are rows of the world's lives, or EMPTY: int64 (T, N).
    """
    traits = run.config.traits
    assert traits is not None
    there = rows != EMPTY
    which, place = np.unique(rows[there], return_inverse=True)
    first = int(np.searchsorted(run.lives.world, world))
    found = np.full((len(traits.names), *rows.shape), np.nan)
    found[:, there] = factors_of(run, traits, first + which).T[:, place]
    return found


def occupants(lives: Lives, cells: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Return the row of the organism in each cell of a world after each tick, or EMPTY: int64 (T, N)."""
    order = np.lexsort((lives.born, lives.cell))
    # Ticks of births are numbered, since a product of a cell and a tick may exceed 64 bits.
    births, birth = np.unique(lives.born, return_inverse=True)
    begun = lives.cell[order].astype(np.int64) * len(births) + birth[order]
    latest = np.searchsorted(births, ticks, side="right") - 1
    at = np.searchsorted(begun, cells * len(births) + latest[:, None], side="right") - 1
    row = order[np.maximum(at, 0)]
    there = (at >= 0) & (lives.cell[row] == cells)
    there &= ~lives.died[row] | (lives.ended[row] > ticks[:, None])
    return np.where(there, row, EMPTY)


def picture(lives: Lives, clades: Clades, cells: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Return the colour of each cell after each tick, float64 (T, N, 3); empty cells are white."""
    rows = occupants(lives, cells, ticks)
    occupied = rows != EMPTY
    codes, place, size = np.unique(
        line_codes(lives, clades, rows, ticks)[occupied], return_inverse=True, return_counts=True
    )
    image = np.ones((*rows.shape, 3))
    image[occupied] = INKS[line_inks(lives, clades, codes, size)[place]]
    return image


def line_inks(lives: Lives, clades: Clades, codes: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return each line's colour, an index in INKS, int64 (K,), from its code and size in the picture.

    Lines of one era take the colours in turn. Those that last to the end of the era come before the
    others, and in both groups larger lines come before smaller ones. Lines that last have strong
    colours, all others pale ones. Lines whose first organism was born after the beginning of the
    era are grey, and so are all lines before the first renewal.
    """
    era, line = np.divmod(codes, len(lives))
    last = int(lives.ended.max())
    ends = np.append(clades.renewals, last + 1)
    final = occupants(lives, np.unique(lives.cell), np.minimum(ends, last))
    lasted = np.isin(codes, line_codes(lives, clades, final, ends - 1)[final != EMPTY])
    order = np.lexsort((-size, ~lasted, era))
    turn = np.empty(len(codes), np.int64)
    turn[order] = np.arange(len(codes)) - np.searchsorted(era[order], era[order])
    colour = (turn + era - 1) % len(STRONG)  # each era begins with a different colour
    young = lives.born[line] > np.append(-1, clades.renewals)[era]
    colour[young] = len(STRONG)
    return np.where(lasted, colour, len(COLOURS) + colour)


def line_codes(lives: Lives, clades: Clades, rows: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Return one number for the era and the line of each organism: era x number of lives + line.

    `rows` and the result are (T, N).

    An era is the time from one renewal of lines to the next.
    """
    era = np.searchsorted(clades.renewals, ticks, side="right")[:, None]
    return era * len(lives) + clades.lines_at(rows, ticks[:, None])


def _label(axes: Axes, config: Config, world: int, shown: int) -> None:
    which = f", world {world} (of {config.seeds})" if config.seeds > 1 else ""
    key = {"strong: lines that lasted;  pale: died out;  white: empty": style.SOFT}
    style.title(axes, f"Lines of descent{which}", key, NAMES if config.islands.count > 1 else 0)
    order = {"ring": " of the ring", "well-mixed": " (all are neighbours)"}
    cell = f"cell{order.get(config.placement.topology, ' of the torus, row after row')}"
    step = -(-config.cells // COLUMNS)
    axes.set_xlabel(cell if step == 1 else f"{cell}; {shown} of {config.cells:,} shown")
    axes.set_ylabel("organisms born so far")
    style.linear(axes.yaxis)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _mark_islands(axes: Axes, islands: Islands) -> None:
    """Draw the borders of islands, and their names above the picture if they have room there."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    room = 72 * 0.75 * figure.get_figwidth() / islands.bounds[-1]
    for name, cells in zip(islands.names, islands.cells, strict=True):
        if cells.start:
            axes.axvline(cells.start - 0.5, color="white", linewidth=1.6)
            axes.axvline(cells.start - 0.5, color=style.INK, linewidth=0.6)
        if len(name) * style.LETTER <= room * len(cells):
            axes.annotate(
                name, ((cells.start + cells.stop - 1) / 2, 1), (0, 3), ha="center", fontsize=6,
                xycoords=axes.get_xaxis_transform(), textcoords="offset points", color=style.INK,
            )  # fmt: skip


def _time_axis(axes: Axes, lives: Lives) -> None:
    """Draw an axis on the right with round numbers of ticks, each at the number of births by that
    tick."""
    right = axes.secondary_yaxis("right")
    powers = 10 ** np.arange(1, len(str(lives.born[-1])))
    places: dict[float, int] = {}
    for tick in np.sort(np.outer((1, 2, 5), powers).ravel()).tolist():
        place = float(np.searchsorted(lives.born, tick, side="right"))
        if place < len(lives) and place - max(places, default=0.0) > len(lives) / 25:
            places[place] = tick
    right.yaxis.set_major_locator(FixedLocator(list(places)))
    right.yaxis.set_major_formatter(FuncFormatter(lambda place, _: style.short(places[place])))
    right.set_ylabel("time (ticks)")
    right.spines["right"].set_visible(False)


def _mark_renewals(axes: Axes, lives: Lives, clades: Clades) -> None:
    """Mark the first renewal of lines and the first takeovers, and write why lines began."""
    takeovers = clades.by_takeover
    for number, (tick, takeover) in enumerate(zip(clades.renewals, takeovers, strict=True)):
        if number and (not takeover or takeovers[:number].sum() >= MAX_TAKEOVERS):
            continue
        # Births of this tick have the colours of the new lines already.
        place = int(np.searchsorted(lives.born, tick)) + 0.5
        at_top = place < len(lives) / 20
        axes.axhline(place, color=style.INK, linewidth=0.6)
        axes.annotate(
            "one line has taken over"
            if takeover
            else f"{crowd_size(lives)} alive: each begins a line",
            (1, place),
            (-2, -2.5 if at_top else 2.5),
            xycoords=axes.get_yaxis_transform(),
            textcoords="offset points",
            ha="right",
            va="top" if at_top else "bottom",
            fontsize=6,
            bbox={"boxstyle": "square,pad=0.1", "color": "white", "alpha": 0.8},
        )
