"""Population, births and deaths over time, and the causes of death."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from primordia.figures import style
from primordia.history import series
from primordia.law.world import Cause
from primordia.runs.lives import Lives
from primordia.runs.records import Records

COLOURS = {
    Cause.FATAL: style.VERMILION,
    Cause.STARVED: style.ORANGE,
    Cause.HAZARD: style.PURPLE,
    Cause.REPLACED: style.SKY,
    Cause.FAULT: style.INK,
    Cause.TIME_LIMIT: style.YELLOW,
    Cause.RESTART: style.GREEN,
}
LIVING = style.BLUE


def draw(run: Records, world: int) -> Figure:
    """Draw the population, the fates of all organisms born, and births and deaths per tick."""
    lives, cells = run.lives.since_fork(), run.config.cells
    figure = Figure(figsize=(style.PAGE, 2.4))
    living, fates, rates = figure.subplots(1, 3)
    causes = [cause for cause in Cause if (lives.cause == cause).any()]
    ticks = series.moments(int(lives.ended.max()))
    _living(living, lives, ticks, cells)
    _fates(fates, lives, ticks, causes)
    _rates(rates, lives, causes)
    for axes in (living, fates, rates):
        style.time_axis(axes, int(lives.ended.max()), style.time_label(lives))
    return figure


def _living(axes: Axes, lives: Lives, ticks: np.ndarray, cells: int) -> None:
    axes.axhline(cells, color=style.FAINT, linewidth=0.8, zorder=0)
    axes.annotate(
        f"all {cells:,} cells", (0.02, cells), (0, 2), color=style.SOFT,
        xycoords=axes.get_yaxis_transform(), textcoords="offset points",
    )  # fmt: skip
    style.curves(
        axes, ticks, series.curve_by_world(series.population, lives.by_world(), ticks), LIVING
    )
    style.linear(axes.yaxis)
    style.title(axes, "Population", style.worlds_key(lives.worlds))
    axes.set(ylabel="organisms", ylim=(0, 1.12 * cells))


def _fates(axes: Axes, lives: Lives, ticks: np.ndarray, causes: list[Cause]) -> None:
    """Draw the fates of organisms in all worlds together; the counts of a stopped world stay constant."""
    born = series.count_until(np.sort(lives.born), ticks)
    dead = [
        series.count_until(np.sort(lives.ended[lives.cause == cause]), ticks) for cause in causes
    ]
    alive = born - np.sum(dead, axis=0, dtype=np.int64)
    colours = [*(COLOURS[cause] for cause in causes), LIVING]
    axes.stackplot(ticks, *dead, alive, colors=colours, linewidth=0)
    key = {"alive": LIVING} | _cause_key("dead", causes) | style.pooled_key(lives.worlds)
    style.title(axes, "Fate of all organisms born", key)
    style.linear(axes.yaxis)
    axes.set_ylim(0, None)


def _rates(axes: Axes, lives: Lives, causes: list[Cause]) -> None:
    """Draw births and deaths in bins of time."""
    middle, births, deaths = rates(lives)
    for rate, colour in [(births, style.INK), *((deaths[each], COLOURS[each]) for each in causes)]:
        axes.plot(middle, rate, ".-", color=colour, markersize=3)
    style.title(axes, "Births and deaths", {"births": style.INK} | _cause_key("deaths", causes))
    style.logarithmic(axes.yaxis)
    axes.set_ylabel("per tick of a world" if lives.worlds > 1 else "per tick")


def rates(lives: Lives) -> tuple[np.ndarray, np.ndarray, dict[Cause, np.ndarray]]:
    """Return the middles of bins of time, and the births and deaths in each bin, float64 (B,).

    They are divided by the ticks that all worlds have lived in the bin. Deaths are given by cause.
    """
    edges = series.bins(int(lives.ended.max()))
    ends = np.array([world.ended.max() for world in lives.by_world()])
    ticks = series.exposure(np.zeros_like(ends), ends, edges)
    at = {cause: lives.ended[lives.cause == cause] for cause in Cause}
    deaths = {cause: series.per_tick(of, ticks, edges) for cause, of in at.items() if len(of)}
    return series.middle(edges), series.per_tick(lives.born, ticks, edges), deaths


def _cause_key(heading: str, causes: list[Cause]) -> dict[str, str]:
    """Return causes of death and their colours; the first cause follows the heading."""
    return {
        cause.label if number else f"{heading}: {cause.label}": COLOURS[cause]
        for number, cause in enumerate(causes)
    }
