"""Results of an experiment: Markdown tables, a CSV file with a row for each world, and a figure."""

import csv
import datetime
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from primordia import files
from primordia.comparison.comparison import Comparison, compare
from primordia.comparison.measured import Measured
from primordia.comparison.tables import (
    effects,
    evidence_notes,
    quartiles_text,
    setting_text,
    spread_text,
)
from primordia.experiments import late
from primordia.figures import style
from primordia.figures.comparison import draw
from primordia.history.extinctions import Extinctions, extinctions_of
from primordia.runs.arrays import NEVER
from primordia.runs.directory import VERSIONS
from primordia.runs.records import Records

NOTES = (
    "Medians over worlds (quartiles); a world that stopped unsaturated is treated as censored.",
    "Crashes: extinctions after half of the cells were full of founders' descendants.",
)
OF_EFFECTS = "Effects: Cliff's delta; ratio of medians (95 % interval over worlds)."

COLUMNS = {
    "first": "first_long_birth",
    "lifespan": "mean_lifespan",
    "longest": "longest_life",
    "pace": "late_ticks_per_death",
    "food": "late_food",
}
"""Outcome of a comparison -> its column in the CSV, which also has births and ticks to saturation."""


def write(stem: Path, question: str, arms: Sequence[Records]) -> list[Path]:
    """Write STEM.md, STEM.csv and STEM.png; the first arm is the reference of the others, if any.

    Raises:
        InputError: nothing has lived in an arm yet, or the arms cannot be compared.
        Trouble: a file cannot be written.
    """
    compared, counted = compare(arms), [counts(arm) for arm in arms]
    paths = [stem.with_name(f"{stem.name}.{suffix}") for suffix in ("md", "csv", "png")]
    picture = f"![The arms side by side]({paths[2].name})"
    parts, notes = [f"# {question}", picture, summary(compared, counted)], list(NOTES)
    ends = [late.last_deaths(arm, compared) for arm in arms] if "pace" in compared.outcomes else []
    if ends:
        parts.append(dying(compared, ends))
    if len(arms) > 1:
        parts.append(table(*effects(compared)))
        notes += [OF_EFFECTS, *evidence_notes(compared)]
    parts += [" ".join(notes), made([each.name for each in compared.arms], arms)]
    files.write_text(paths[0], "\n\n".join(parts) + "\n")
    files.write_text(paths[1], world_rows(compared, counted, ends))
    with style.applied():
        figure = draw(compared)
        files.write(paths[2], lambda file: figure.savefig(file, dpi=200, format="png"))
    return paths


def counts(arm: Records) -> dict[str, np.ndarray]:
    """Return seeds and counts of an arm's worlds, each (W,); NEVER for saturation not yet reached.

    In a fork, extinctions and crashes are those since the fork.
    """
    lost = extinctions_of(arm)
    return {
        "seed": arm.world_seeds,
        "ticks": arm.count("world.worlds.tick"),
        "births": arm.count("world.worlds.births"),
        "extinctions": lost.total,
        "crashes": lost.crashes,
        "alive": arm.state["world.organisms.alive"].reshape(len(arm.world_seeds), -1).sum(axis=1),
        "saturated_births": arm.count("world.worlds.saturated_births"),
        "saturated_tick": arm.count("world.worlds.saturated"),
    }


def summary(compared: Comparison, counted: list[dict[str, np.ndarray]]) -> str:
    """Return a table with a row for each arm: medians over worlds, with quartiles."""
    names = list(compared.arms[0].settings)
    outcomes = compared.outcomes
    head = [
        "",
        *names,
        "worlds",
        "saturated",
        "extinctions (median)",
        "crashes",
        *outcomes.values(),
    ]
    rows = [
        [
            arm.name,
            *map(setting_text, arm.settings.values()),
            arm.worlds,
            arm.saturated,
            f"{np.median(numbers['extinctions']):g}",
            Extinctions(numbers["extinctions"], numbers["crashes"]).text,
        ]
        + [quartiles_text(arm, outcome) for outcome in outcomes]
        for arm, numbers in zip(compared.arms, counted, strict=True)
    ]
    return table(head, rows)


def dying(compared: Comparison, ends: list[list[dict[str, float]]]) -> str:
    """Return a table of the last deaths in each arm: medians and quartiles over worlds."""
    names = [name for name in late.COLUMNS if name in ends[0][0]]
    rows = [
        [arm.name, *(spread_text([world[name] for world in worlds]) for name in names)]
        for arm, worlds in zip(compared.arms, ends, strict=True)
    ]
    return table(["", *(late.COLUMNS[name] for name in names)], rows)


def table(head: list[str], rows: list[list[Any]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def made(names: Sequence[str], arms: Sequence[Records]) -> str:
    """Return the first day and the versions of the experiment, and the limits at which worlds stopped."""
    files_of_start = [path / VERSIONS for arm in arms for path in arm.paths]
    begun = datetime.date.fromtimestamp(min(file.stat().st_mtime for file in files_of_start))
    versions = _by_arm(names, [", ".join(map(_named, arm.versions.items())) for arm in arms])
    limits = _by_arm(names, [" or ".join(map(_named, _limits(arm))) for arm in arms])
    return f"Run on {begun} with {versions}. Each world stopped at: {limits}."


def _named(pair: tuple[str, Any]) -> str:
    return f"{pair[0]} {pair[1]}"


def _limits(arm: Records) -> list[tuple[str, Any]]:
    return [limit for limit in arm.progress.limits if limit[1] is not None]


def _by_arm(names: Sequence[str], texts: Sequence[str]) -> str:
    """Return the arms' text, once if it is the same for all of them, or else with their names."""
    arms: dict[str, list[str]] = {}
    for name, text in zip(names, texts, strict=True):
        arms.setdefault(text, []).append(name)
    if len(arms) == 1:
        return texts[0]
    return "; ".join(f"{text} ({', '.join(which)})" for text, which in arms.items())


def world_rows(
    compared: Comparison, counted: list[dict[str, np.ndarray]], ends: list[list[dict[str, float]]]
) -> str:
    """Return CSV with a row for each world of each arm; the cell of an unknown value is empty."""
    arms = compared.arms
    known = [name for name in COLUMNS if name in compared.outcomes]
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    titles = [COLUMNS[name] for name in known]
    rows.writerow(["arm", *counted[0], *titles, *(ends[0][0] if ends else ())])
    for number, (arm, numbers) in enumerate(zip(arms, counted, strict=True)):
        columns = [column.tolist() for column in numbers.values()]
        columns += [_cells(arm.measured[name]) for name in known]
        for world, row in enumerate(zip(*columns, strict=True)):
            last = ends[number][world].values() if ends else ()
            # NaN differs from itself
            cells = ("" if cell == NEVER or cell != cell else cell for cell in (*row, *last))
            rows.writerow([arm.name, *cells])
    return text.getvalue()


def _cells(measured: Measured) -> list[str]:
    values = zip(measured.value.tolist(), measured.known.tolist(), strict=True)
    return [_number(value) if known else "" for value, known in values]


def _number(value: float) -> str:
    """Return a number with two decimals, and one below 100 with four digits."""
    return f"{value:.4g}" if abs(value) < 100 else f"{round(value, 2):.10g}"
