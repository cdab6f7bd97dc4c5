"""The figure of islands: who lives on each of them over time, how old, and how many children arrive."""

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history import series
from primordia.history.islands import migrants
from primordia.runs.lives import Lives
from primordia.runs.records import Records
from primordia.settings.islands import Islands

BANDS = 4
"""Largest number of islands whose lines have bands of quartiles."""


def draw(run: Records, world: int) -> Figure | None:
    """Draw population, mean age and arrivals on each island; None if the worlds have no islands."""
    islands = run.config.islands
    if islands.count == 1:
        return None
    lives = run.lives.since_fork()
    figure = Figure(figsize=(style.PAGE, 2.5))
    living, ages, arrivals = figure.subplots(1, 3)
    ticks = series.moments(int(lives.ended.max()))
    colours, sizes = style.island_colours(islands.names), np.array(islands.sizes)
    full = by_island(series.population, lives, islands, ticks) / sizes[:, None, None]
    _lines(living, ticks, full, colours)
    style.title(living, "Inhabited cells", colours)
    living.set(ylabel="share of the island's cells", ylim=(-0.02, 1.05))
    old = series.positive(by_island(series.mean_age, lives, islands, ticks))
    _lines(ages, ticks, old, colours)
    style.logarithmic(ages.yaxis)
    over = {"medians and quartiles of worlds": style.SOFT} if lives.worlds > 1 else {}
    style.title(ages, "Mean age of the living", over)
    ages.set_ylabel("ticks")
    middle, arrived = arrived_shares(lives, islands)
    for share, colour in zip(arrived, colours.values(), strict=True):
        arrivals.plot(middle, share, ".-", color=colour, markersize=3)
    style.title(arrivals, "Children of parents elsewhere", style.pooled_key(lives.worlds))
    arrivals.set(ylabel="share of births on the island", ylim=(-0.02, 1.05))
    for axes in (living, ages, arrivals):
        style.time_axis(axes, int(lives.ended.max()), style.time_label(lives))
    return figure


def by_island(
    curve: Callable[[Lives, np.ndarray], np.ndarray],
    lives: Lives,
    islands: Islands,
    ticks: np.ndarray,
) -> np.ndarray:
    """Return a curve of the organisms of each island in each world, float64 (K, W, T).

    Args:
        curve: as in `series.curve_by_world`, such as `series.population`.
        lives: the lives of W worlds.
        islands: the K islands of a world.
        ticks: the moments, int64 (T,).
    """

    def of(number: int) -> np.ndarray:
        def there(world: Lives, ticks: np.ndarray) -> np.ndarray:
            own = np.flatnonzero(islands.of_cells(world.cell) == number)
            return curve(world.take(own), ticks)

        return series.curve_by_world(there, worlds, ticks)

    worlds = lives.by_world()
    return np.array([of(number) for number in range(islands.count)])


def arrived_shares(lives: Lives, islands: Islands) -> tuple[np.ndarray, np.ndarray]:
    """Return the middles of bins of time, (B,), and the share of an island's children in each bin
    whose parent lives on another island, float64 (K, B); NaN for fewer than series.MIN_EVENTS births.

    All worlds count together.
    """
    edges = series.bins(int(lives.ended.max()))
    home = islands.of_cells(lives.cell)
    arrived = migrants(lives.parent_row, home)
    child = lives.parent_row >= 0
    shares = np.full((islands.count, len(edges) - 1), np.nan)
    for k in range(islands.count):
        births, arrivals = (
            np.diff(series.count_until(np.sort(lives.born[rows]), edges))
            for rows in (child & (home == k), arrived & (home == k))
        )
        enough = births >= series.MIN_EVENTS
        shares[k, enough] = arrivals[enough] / births[enough]
    return series.middle(edges), shares


def _lines(axes: Axes, ticks: np.ndarray, values: np.ndarray, colours: dict[str, str]) -> None:
    """Draw the median over worlds of each island, (K, W, T), with quartiles if islands are few."""
    for of_worlds, colour in zip(values, colours.values(), strict=True):
        low, median, high = series.spread(of_worlds)
        if len(values) <= BANDS and len(of_worlds) > 1:
            axes.fill_between(ticks, low, high, color=colour, alpha=0.18, linewidth=0)
        axes.plot(ticks, median, color=colour)
