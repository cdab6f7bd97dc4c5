"""Who lived where, of which line of descent: cells across, births downwards."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter

from primordia.config import Config
from primordia.figures import style
from primordia.history import series
from primordia.history.clades import Clades, clades
from primordia.history.lines import CROWD
from primordia.runs.archive import Archive
from primordia.runs.lives import Lives

ROWS, COLUMNS = 800, 512
"""Most moments, and cells, that are drawn; of more, each second or third is."""
NOBODY = -1
HUES = (
    style.BLUE, style.ORANGE, style.GREEN, style.PURPLE, style.SKY, style.VERMILION, style.YELLOW,
)  # fmt: skip
STRONG = np.concatenate([share * np.array([to_rgb(hue) for hue in HUES]) for share in (1, 0.6)])
YOUNG = "#a0a0a0"
PALE = 0.7
"""Share of white in the colour of a line that died out."""
NAMED = 8
"""Most takeovers that are pointed out."""


def draw(run: Archive, world: int) -> Figure:
    """Draw one world. Time runs in births: a world that lives long is calm for most of its ticks."""
    figure = Figure(figsize=(style.COLUMN, 4.8))
    axes = figure.subplots()
    here, config = run.lives.of_world(world), run.config
    births = np.unique(np.linspace(0, len(here) - 1, ROWS).astype(np.int64))
    cells = np.arange(0, config.cells, -(-config.cells // COLUMNS))
    of = told_apart(here)
    axes.imshow(
        picture(here, of, cells, here.born[births]),
        aspect="auto",
        interpolation="nearest",
        extent=(-0.5, config.cells - 0.5, len(here) + 0.5, 0.5),
    )
    _label(axes, config, world, len(cells))
    _time(axes, here)
    _point_out(axes, here, of)
    return figure


def told_apart(lives: Lives) -> Clades:
    """Lines of one world."""
    return clades(lives.parent_row, lives.born, lives.ended, lives.died, crowd(lives))


def crowd(lives: Lives) -> int:
    """How many must live in a world for lines to be told apart; it did hold twice as many."""
    most = int(series.population(lives, lives.born).max())
    return min(CROWD, max(most // 2, 1))


def living(lives: Lives, cells: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Row of who lives in each cell after each tick of one world, int64 (T, N), or NOBODY."""
    order = np.lexsort((lives.born, lives.cell))
    span = int(lives.ended.max()) + 1
    begun = lives.cell[order].astype(np.int64) * span + lives.born[order]
    at = np.searchsorted(begun, cells * span + ticks[:, None], side="right") - 1
    row = order[np.maximum(at, 0)]
    there = (at >= 0) & (lives.cell[row] == cells)
    there &= ~lives.died[row] | (lives.ended[row] > ticks[:, None])
    return np.where(there, row, NOBODY)


def picture(lives: Lives, of: Clades, cells: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Colour of each cell after each tick, float64 (T, N, 3); white where nobody lives."""
    found = living(lives, cells, ticks)
    lived = found != NOBODY
    named, place, size = np.unique(
        _name(lives, of, found, ticks)[lived], return_inverse=True, return_counts=True
    )
    image = np.ones((*found.shape, 3))
    image[lived] = shades(lives, of, named, size)[place]
    return image


def shades(lives: Lives, of: Clades, named: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Colours of lines, float64 (K, 3), by their names from `_name` and sizes in the picture.

    Lines that were told apart together take the colours in turn, the largest first. Those that
    lasted until lines were told apart anew, or to the end, are strong, others pale. What lived
    before lines were first told apart is grey.
    """
    era, line = np.divmod(named, len(lives))
    last = int(lives.ended.max())
    ends = np.append(of.renewals, last + 1)
    final = living(lives, np.unique(lives.cell), np.minimum(ends, last))
    lasted = np.isin(named, _name(lives, of, final, ends - 1)[final != NOBODY])
    order = np.lexsort((-size, ~lasted, era))
    turn = np.empty(len(named), np.int64)
    turn[order] = np.arange(len(named)) - np.searchsorted(era[order], era[order])
    colour = STRONG[(turn + era - 1) % len(STRONG)]  # from takeover to takeover, another begins
    young = lives.born[line] > np.append(-1, of.renewals)[era]
    colour[young] = to_rgb(YOUNG)
    return np.where(lasted[:, None], colour, 1 - (1 - colour) * (1 - PALE))


def _name(lives: Lives, of: Clades, rows: np.ndarray, ticks: np.ndarray) -> np.ndarray:
    """Of lines (T, N), each time they are told apart anew: era x number of lives + line."""
    era = np.searchsorted(of.renewals, ticks, side="right")[:, None]
    return era * len(lives) + of.lines_at(rows, ticks[:, None])


def _label(axes: Axes, config: Config, world: int, shown: int) -> None:
    of_many = f", world {world} (of {config.seeds})" if config.seeds > 1 else ""
    key = {"strong: lines that lasted;  pale: died out;  white: empty": style.SOFT}
    style.title(axes, f"Lines of descent{of_many}", key)
    order = {"ring": " of the ring", "well-mixed": " (all are neighbours)"}
    cell = f"cell{order.get(config.placement.topology, ' of the torus, row after row')}"
    step = -(-config.cells // COLUMNS)
    axes.set_xlabel(cell if step == 1 else f"{cell}; {shown} of {config.cells:,} shown")
    axes.set_ylabel("organisms born so far")
    style.counted(axes.yaxis)
    for spine in axes.spines.values():
        spine.set_visible(False)


def _time(axes: Axes, lives: Lives) -> None:
    """On the right, at how many births each round number of ticks came."""
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


def _point_out(axes: Axes, lives: Lives, of: Clades) -> None:
    """Where lines were told apart anew, and why."""
    for number, (tick, takeover) in enumerate(zip(of.renewals, of.by_takeover, strict=True)):
        if number and (not takeover or of.by_takeover[:number].sum() >= NAMED):
            continue
        place = int(np.searchsorted(lives.born, tick, side="right")) + 0.5
        at_top = place < len(lives) / 20
        axes.axhline(place, color=style.INK, linewidth=0.6)
        axes.annotate(
            "one line has taken over" if takeover else f"{crowd(lives)} alive: each begins a line",
            (1, place),
            (-2, -2.5 if at_top else 2.5),
            xycoords=axes.get_yaxis_transform(),
            textcoords="offset points",
            ha="right",
            va="top" if at_top else "bottom",
            fontsize=6,
            bbox={"boxstyle": "square,pad=0.1", "color": "white", "alpha": 0.8},
        )
