"""The arms of an experiment side by side: a table of outcomes, effects, and curves."""

from collections.abc import Sequence
from typing import Any

from primordia.comparison.comparison import Comparison, compare
from primordia.comparison.tables import (
    effects,
    evidence_notes,
    quartiles_text,
    setting_text,
)
from primordia.figures import style
from primordia.figures.comparison import line_styles
from primordia.history import series
from primordia.report.curves import Panel, curve, panel, table, thinned
from primordia.runs.records import Records


def arms(runs: Sequence[Records]) -> dict[str, Any]:
    """Return the arms side by side, the first as the reference, for `arms.js`.

    Returns:
        `tables`: each with a `head` and `rows` of texts; `notes`; `panels` of curves.

    Raises:
        InputError: nothing has lived in an arm, or the arms cannot be compared.
    """
    lines = line_styles(len(runs))
    colours = [str(line["color"]) for line in lines]
    if len(runs) < 2:
        return {"tables": [], "notes": [], "panels": _over_time(runs, colours)}
    compared = compare(runs)
    head, rows = effects(compared)
    return {
        "tables": [_outcomes(compared), {"title": "Effects", "head": head, "rows": rows}],
        "notes": [
            "Medians over worlds, with quartiles; a world that stopped unsaturated is treated as"
            " censored. Effects: Cliff's delta, over all worlds and within seeds; the ratio of medians.",
            *evidence_notes(compared),
        ],
        "panels": [_survival(compared, colours), *_over_time(runs, colours)],
    }


def names(runs: Sequence[Records]) -> list[str]:
    """Return the name of each arm."""
    return [run.path.resolve().name for run in runs]


def _outcomes(compared: Comparison) -> dict[str, Any]:
    settings = list(compared.arms[0].settings)
    rows = [
        [
            arm.name,
            *map(setting_text, arm.settings.values()),
            f"{arm.saturated:,} of {arm.worlds:,}",
            *(quartiles_text(arm, outcome) for outcome in compared.outcomes),
        ]
        for arm in compared.arms
    ]
    head = ["arm", *settings, "worlds saturated", *compared.outcomes.values()]
    return {"title": "Outcomes", "head": head, "rows": rows}


def _survival(compared: Comparison, colours: Sequence[str]) -> Panel:
    tables = []
    for arm, colour in zip(compared.arms, colours, strict=True):
        lived = arm.survival
        steps, alive = thinned(lived.steps.clip(1), lived.with_ends(lived.curve))
        tables.append(table(steps, curve(arm.name, alive, colour, "steps")))
    return panel(
        "Alive at each age", "The share of organisms of each arm that reach each age.",
        "age (ticks)", "fraction alive", tables, log_x=True,
    )  # fmt: skip


def _over_time(runs: Sequence[Records], colours: Sequence[str]) -> list[Panel]:
    """Return mean age and population of the arms: the median of worlds, over time."""
    worlds = [run.lives.since_fork().by_world() for run in runs]
    ticks = series.moments(max(int(world.ended.max()) for each in worlds for world in each))
    time = style.time_label(runs[0].lives.since_fork())
    shown = {
        "Mean age of the living": (series.mean_age, "age (ticks)", True),
        "Organisms alive": (series.population, "organisms", False),
    }
    panels = []
    for title, (of, label, log) in shown.items():
        curves = []
        for name, each, colour in zip(names(runs), worlds, colours, strict=True):
            median = series.spread(series.curve_by_world(of, each, ticks))[1]
            curves.append(curve(name, series.positive(median) if log else median, colour))
        about = f"{title} over time in each arm, median over worlds."
        panels.append(
            panel(title, about, time, label, [table(ticks, *curves)], log_x=True, log_y=log)
        )
    return panels
