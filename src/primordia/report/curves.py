"""Curves of a run as data: panels that `curves.js` draws."""

from collections.abc import Iterable
from typing import Any, Literal

import numpy as np

from primordia.engine.tallies import tally_columns
from primordia.figures import style
from primordia.figures.ages import quartiles
from primordia.figures.population import COLOURS, LIVING, rates
from primordia.figures.survival import COHORTS, alive_at, quarters
from primordia.history import series
from primordia.history.foraging import foraging
from primordia.history.investment import investment
from primordia.history.traits import course
from primordia.runs.lives import Lives
from primordia.runs.records import Records

FEW = 8
"""Largest number of worlds whose curves are drawn one by one."""
DOTS = 2000
"""Largest number of dots for each group: the dead, and the living."""
POINTS = 600
"""Largest number of points in a curve that is thinned."""

Panel = dict[str, Any]
Kind = Literal["line", "faint", "low", "high", "dots", "steps", "limit"]


def panels(run: Records) -> list[Panel]:
    """Return all panels of a run."""
    lives = run.lives.since_fork()
    worlds, ticks = lives.by_world(), series.moments(int(lives.ended.max()))
    time = style.time_label(lives)
    return [
        _ages(worlds, ticks, time),
        _deaths(lives),
        _living(worlds, ticks, run.config.cells, time),
        _rates(lives, time),
        _survival(lives),
        *_foraging(run),
        *_investment(run),
        *_traits(run),
        *_counts(run),
    ]


def panel(title: str, about: str, x: str, y: str, tables: Iterable[dict], **scales: bool) -> Panel:
    """Return a panel.

    Args:
        title: the title.
        about: a description for people who cannot see the panel.
        x: label of the x axis.
        y: label of the y axis.
        tables: curves that share x; see `table`.
        scales: `log_x` and `log_y`, whether an axis is logarithmic.
    """
    return {"title": title, "about": about, "x": x, "y": y, "tables": list(tables), **scales}


def table(x: np.ndarray, *curves: dict[str, Any]) -> dict[str, Any]:
    """Return curves over the same ascending x; among points with equal x the last is kept."""
    places, last = numbers(x, digits=9), np.append(np.diff(x) > 0, True)[: len(x)]
    keep = np.flatnonzero(last).tolist()
    kept = [{**each, "values": [each["values"][i] for i in keep]} for each in curves]
    return {"x": [places[i] for i in keep], "curves": kept}


def curve(name: str, values: np.ndarray, colour: str, kind: Kind = "line") -> dict[str, Any]:
    """Return a curve; NaN leaves a gap. A curve without a name is not in the legend."""
    return {"name": name, "values": numbers(values), "colour": colour, "kind": kind}


def numbers(values: np.ndarray, digits: int = 5) -> list[float | None]:
    """Return numbers for JSON; None for numbers that are not finite."""
    rounded = (
        float(f"{value:.{digits}g}") if np.isfinite(value) else None for value in values.tolist()
    )
    return [int(each) if each is not None and each == int(each) else each for each in rounded]


def over_worlds(
    name: str, x: np.ndarray, values: np.ndarray, colour: str, each: bool = True
) -> dict[str, Any]:
    """Return a table: median and quartiles of worlds (W, X), and each world's curve if they are few."""
    if len(values) == 1:
        return table(x, curve(name, values[0], colour))
    low, median, high = series.spread(values)
    few = values if each and len(values) <= FEW else values[:0]
    return table(
        x,
        *(curve("", world, colour, "faint") for world in few),
        curve("", high, colour, "high"),
        curve("", low, colour, "low"),
        curve(f"{name}, median and quartiles of {len(values)} worlds", median, colour),
    )


def _ages(worlds: list[Lives], ticks: np.ndarray, time: str) -> Panel:
    ages = series.curve_by_world(series.mean_age, worlds, ticks)
    return panel(
        "Mean age of the living", "The mean age of the living over time, in ticks.", time,
        "age (ticks)", [over_worlds("mean age", ticks, series.positive(ages), style.BLUE)],
        log_x=True, log_y=True,
    )  # fmt: skip


def _deaths(lives: Lives) -> Panel:
    """Return lifespans by order of birth, with quartiles over the dead."""
    number = lives.rank + 1 + lives.world / lives.worlds  # so that no two worlds share a number
    lifespan, died, tables = lives.lifespan, lives.died, []
    for name, group, colour in (("dead", died, style.SKY), ("alive", ~died, style.ORANGE)):
        some = np.flatnonzero(group)[:: int(group.sum()) // DOTS + 1]
        some = some[np.argsort(number[some], kind="stable")]
        if len(some):
            tables.append(table(number[some], curve(name, lifespan[some].clip(1), colour, "dots")))
    if died.any():
        middle, low, median, high = quartiles(number[died], lifespan[died].clip(1))
        tables.append(
            table(
                middle,
                curve("", high, style.BLUE, "high"),
                curve("", low, style.BLUE, "low"),
                curve("median age at death", median, style.BLUE),
            )
        )
    return panel(
        "Age at death", "The age at which each organism died, or the present age of a living organism.",
        "organism, in order of birth", "age (ticks)", tables, log_y=True,
    )  # fmt: skip


def _living(worlds: list[Lives], ticks: np.ndarray, cells: int, time: str) -> Panel:
    living = series.curve_by_world(series.population, worlds, ticks)
    return panel(
        "Organisms alive", "The number of living organisms over time.", time, "organisms",
        [
            table(ticks, curve(f"all {cells:,} cells", np.full(len(ticks), cells), style.FAINT, "limit")),
            over_worlds("alive", ticks, living, LIVING),
        ], log_x=True,
    )  # fmt: skip


def _rates(lives: Lives, time: str) -> Panel:
    """Return rates of births, and of deaths by cause, in bins of time."""
    middle, births, deaths = rates(lives)
    curves = [curve("births", births, style.INK)] + [
        curve(f"deaths: {cause.label}", rate, COLOURS[cause]) for cause, rate in deaths.items()
    ]
    return panel(
        "Births and deaths", "Births and deaths per tick of a world over time, by cause.", time,
        "per tick of a world" if lives.worlds > 1 else "per tick",
        [table(middle, *curves)], log_x=True, log_y=True,
    )  # fmt: skip


def _survival(lives: Lives) -> Panel:
    """Return the share alive at each age (Kaplan-Meier), for each quarter of the births."""
    longest = int(lives.lifespan.max())
    tables = []
    for cohort, (name, colour) in zip(quarters(lives), COHORTS.items(), strict=True):
        if len(cohort):
            ages, alive = alive_at(cohort, longest)
            steps, alive = thinned(ages.clip(1), alive)
            tables.append(table(steps, curve(f"{name} of the births", alive, colour, "steps")))
    return panel(
        "Alive at each age", "The share of organisms that reach each age, by quarter of the "
        "births.",
        "age (ticks)", "fraction alive", tables, log_x=True,
    )  # fmt: skip


def thinned(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the points of a curve that a logarithmic axis can tell apart, and always the last point."""
    cut = np.floor(POINTS * np.log(x) / max(np.log(float(x[-1])), 1e-9))
    keep = np.flatnonzero(np.append(np.diff(cut), 1))
    return x[keep], y[keep]


def _foraging(run: Records) -> list[Panel]:
    """Return the food that an organism gathers, if the run has a metabolism and samples."""
    if run.config.metabolism is None or not len((found := foraging(run)).middle):
        return []
    rate = run.description.rate
    unit = "second" if rate else "tick"
    food, enough = (each * (rate or 1) for each in (found.food, found.break_even))
    about = "The food that an organism gathers, and the food that keeps the energy constant."
    tables = [
        over_worlds("food", found.middle, food, style.BLUE),
        over_worlds("break-even", found.middle, enough, style.ORANGE, each=False),
    ]
    return [panel("Food", about, "time (ticks)", f"food in a {unit}", tables)]


def _investment(run: Records) -> list[Panel]:
    """Return the energy that parents give to their children, if replication is an act."""
    if run.config.act is None or not np.isfinite((found := investment(run)).endowment).any():
        return []
    about = "The mean energy that a child begins with, over births."
    tables = [over_worlds("endowment", found.middle, found.endowment, style.BLUE)]
    return [panel("Energy given to a child", about, "organisms born so far", "endowment", tables)]


def _traits(run: Records) -> list[Panel]:
    """Return each trait of the newborn and of their neutral shadows, if bodies are inherited."""
    traits, found = run.config.traits, course(run)
    if traits is None or found is None:
        return []
    panels = []
    for name, own, shadows in zip(traits.names, found.own, found.shadows, strict=True):
        about = f"The trait {name} of the newborn and of their neutral shadows, over births."
        tables = [
            over_worlds("neutral shadows", found.middle, shadows, style.ORANGE, each=False),
            over_worlds("organisms", found.middle, own, style.BLUE),
        ]
        x = "organisms born so far"
        panels.append(panel(f"Trait: {name}", about, x, "factor", tables, log_y=True))
    return panels


def _counts(run: Records) -> list[Panel]:
    """Return the habitat's counts, such as a score: mean and best of the living."""
    metrics, found = run.metrics, []
    if not len(metrics):
        return []
    world, tick = metrics["world"].to_numpy(), metrics["tick"].to_numpy()
    ticks = np.unique(tick)
    ticks = np.unique(ticks[:: -(-len(ticks) // POINTS)])
    for name in run.description.tallies:
        tables = []
        for column, colour in zip(tally_columns((name,)), (style.BLUE, style.ORANGE), strict=True):
            sampled = metrics[column].to_numpy()
            values = [
                _at(ticks, tick[world == w], sampled[world == w]) for w in range(run.config.seeds)
            ]
            label = column.removeprefix(f"{name}_")
            tables.append(over_worlds(label, ticks, np.array(values), colour, each=False))
        title = f"{name} of the living"
        about = f"The habitat's count {name}: mean and best of the living, over time."
        found.append(panel(title, about, "time (ticks)", name, tables))
    return found


def _at(ticks: np.ndarray, sampled: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the values sampled at exactly these ticks, float64; NaN where there is no sample."""
    place = np.minimum(np.searchsorted(sampled, ticks), max(len(sampled) - 1, 0))
    if not len(sampled):
        return np.full(len(ticks), np.nan)
    return np.where(sampled[place] == ticks, values[place], np.nan)
