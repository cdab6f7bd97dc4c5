"""A comparison as text: tables, and notes that explain them."""

import json
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from primordia.comparison.comparison import ComparedArm, Comparison
from primordia.comparison.contrast import Contrast
from primordia.comparison.measured import Bounds
from primordia.comparison.resample import LEAST, MISSED, least

DIRECTIONS = {
    "first": ("earlier", "later"),
    "births": ("earlier", "later"),
    "ticks": ("earlier", "later"),
    "lifespan": ("shorter", "longer"),
    "longest": ("shorter", "longer"),
    "pace": ("fewer", "more"),
    "food": ("less", "more"),
}
"""Words for a smaller and a larger value of each outcome."""

WIDE = 1000
"""Width of the text in characters, enough that no line is broken."""


def comparison_tables(compared: Comparison) -> str:
    """Return all tables of a comparison, with a row for each run, and the notes."""
    console = Console(width=WIDE, color_system=None, markup=False, emoji=False)
    with console.capture() as captured:
        console.print(_runs(compared))
        for outcome in compared.outcomes:
            console.print(_against(compared, outcome))
    lines = [line.rstrip() for line in captured.get().splitlines()]
    text = "\n".join([*lines, *_notes(compared)])
    return text.replace("\n\n\n", "\n\n").strip()


def quartiles_text(arm: ComparedArm, outcome: str) -> str:
    """Return the median as text, with the quartiles in brackets if these two are not equal."""
    quartiles = (bounds_text(arm.measured[outcome].quantile(q)) for q in (0.25, 0.5, 0.75))
    q1, median, q3 = quartiles
    return f"{median} ({q1} to {q3})" if q1 != q3 else median


def spread_text(values: Iterable[float]) -> str:
    """Return the median and the quartiles of the known values as text; a dash if there are none."""
    known = [value for value in values if not math.isnan(value)]
    if not known:
        return "-"
    median, q1, q3 = (number_text(float(each)) for each in np.percentile(known, (50, 25, 75)))
    return f"{median} ({q1} to {q3})" if q1 != q3 else median


def effect_text(against: Contrast, outcome: str) -> str:
    """Return delta as text, with a word for its size, and its direction."""
    smaller, larger = DIRECTIONS[outcome]
    direction = f" {larger if against.delta > 0 else smaller}" if against.delta else ""
    percent = math.floor(100 * against.decided + 1e-9)  # 100 * 0.29 is below 29
    known = f"; order known in {percent} % of pairs" if against.decided < 1 else ""
    word = f" {against.word}" if against.word else ""
    return f"{against.delta:+.2f}{word}{direction}{known}"


def paired_text(against: Contrast) -> str:
    """Return delta within pairs of worlds as text; "" if there are no pairs."""
    return f"{against.paired.delta:+.2f}" if against.paired else ""


def needed_text(against: Contrast) -> str:
    """Return, as text, how many worlds an arm needs to show this effect; "" if unknown."""
    return "" if against.needed is None else f"{against.needed:,} worlds an arm"


def ratio_text(against: Contrast) -> str:
    """Return the ratio of medians, with its interval if there is one, as text."""
    ratio = bounds_text(against.ratio)
    if against.interval is None:
        return ratio
    low, high = map(number_text, against.interval)
    return f"{ratio} ({low} to {high})"


def bounds_text(bounds: Bounds) -> str:
    """Return a value, or its known bounds, as text."""
    low, high = bounds
    if low == high:
        return number_text(low)
    if math.isinf(high):
        return f">= {number_text(low)}" if low else "unknown"
    return f"{number_text(low)}..{number_text(high)}"


def setting_text(value: Any) -> str:
    """Return the text of a setting, as in TOML and flags."""
    if value is None:
        return "none"
    return value if isinstance(value, str) else json.dumps(value)


def number_text(value: float) -> str:
    """Return a number as text, precise to at least three digits, with commas between thousands."""
    if math.isinf(value):
        return "inf"
    return f"{value:,.0f}" if abs(value) >= 100 or value == round(value) else f"{value:.3g}"


def _runs(compared: Comparison) -> Table:
    """Return a table of the settings in which runs differ, and of the worlds that saturated.

    What is counted for whole worlds alone is left out if the comparison is one of an island.
    """
    units = {"births": compared.births, "ticks": compared.ticks}
    horizons = [f"{horizon:,} {unit}" for unit, horizon in units.items() if horizon is not None]
    settings = compared.arms[0].settings
    saturated = f"saturated within {' and '.join(horizons)}" if horizons else "saturated"
    of_worlds = (saturated, "extinctions", "crashes") if compared.island is None else ()
    table = _table(compared.task, *settings, "worlds", *of_worlds)
    for arm in compared.arms:
        own = [setting_text(value) for value in arm.settings.values()]
        lost = arm.extinctions
        counts = str(arm.saturated), str(lost.total.sum()), lost.text
        table.add_row(arm.name, *own, str(arm.worlds), *counts[: len(of_worlds)])
    return table


def _against(compared: Comparison, outcome: str) -> Table:
    """Return a table of one outcome, of each run and of each run against the first run."""
    reference, *others = compared.arms
    against = {arm.name: compared.contrast(arm, outcome) for arm in others}
    columns = {
        "delta": {name: effect_text(each, outcome) for name, each in against.items()},
        "within seeds": {name: paired_text(each) for name, each in against.items()},
        _ratio_title(list(against.values())): {
            name: ratio_text(each) for name, each in against.items()
        },
        "needs": {name: needed_text(each) for name, each in against.items()},
    }
    shown = {title: cells for title, cells in columns.items() if any(cells.values())}
    table = _table(compared.outcomes[outcome], "median (quartiles)", *shown)
    table.add_row(reference.name, quartiles_text(reference, outcome), "reference")
    for arm in others:
        cells = [column[arm.name] for column in shown.values()]
        table.add_row(arm.name, quartiles_text(arm, outcome), *cells)
    return table


def _ratio_title(against: list[Contrast]) -> str:
    """Return the title of the ratio's column, with the coverage of its intervals."""
    if all(each.interval is None for each in against):
        return "ratio of medians"
    return f"ratio of medians ({100 * (1 - MISSED):.0f} %{' for all' if len(against) > 1 else ''})"


def evidence_notes(compared: Comparison) -> list[str]:
    """Return notes that explain pairs, intervals and counts of needed worlds, if the tables have them."""
    against = [compared.contrast(arm, "births") for arm in compared.arms[1:]]
    notes = []
    if any(each.paired for each in against):
        notes.append(
            "Within seeds: delta within pairs of worlds with equal seeds. Intervals resample these"
            " pairs."
        )
    if len(against) > 1 and any(each.interval for each in against):
        notes.append(
            f"All intervals of an outcome hold simultaneously in {100 * (1 - MISSED):.0f} % of"
            f" cases, each alone in {100 * against[0].coverage:.4g} % (Bonferroni, for"
            f" {len(against)} contrasts)."
        )
    if any(each.worlds >= LEAST for each in against):
        level = f"{100 * (1 - against[0].coverage):.3g} %"
        notes.append(
            "Needs: the number of worlds in each arm at which 80 % of experiments find an effect"
            f" of this size, at a level of {level} (Noether 1987)."
        )
    return notes


def _table(*columns: str) -> Table:
    return Table(*columns, box=box.SIMPLE_HEAD, pad_edge=False)


def _notes(compared: Comparison) -> list[str]:
    notes = [
        "Medians and intervals are over worlds. A world that stopped unsaturated is treated as"
        " censored."
    ]
    if compared.island is not None:
        notes = [
            f"Only organisms that were born on the island {compared.island} count, wherever their parents"
            " lived. Saturation, extinctions and food are counted for whole worlds, so they are left"
            " out. Medians and intervals are over worlds."
        ]
    notes += _too_few(compared) + evidence_notes(compared)
    if compared.island is None and any(arm.extinctions.crashes.any() for arm in compared.arms):
        notes.append(
            "Crashes: extinctions after founders' descendants had filled half of the cells."
        )
    if compared.begin:
        notes.append(
            f"Births, ticks and lives count from tick {compared.begin:,}, the tick of the fork."
        )
    if {"pace", "food"} & set(compared.outcomes):
        notes.append("Late: the last quarter of the time that all worlds have lived through.")
    return [
        *notes,
        f"A long life: {compared.age:,} ticks. Mean lifespan: ticks in each world, up to that age, and no"
        " longer than its longest life (Kaplan-Meier).",
        "Delta: Cliff's delta, the share of pairs of worlds in which the run's value is larger"
        " than the reference's,",
        "minus the share in which the run's value is smaller.",
    ]


def _too_few(compared: Comparison) -> list[str]:
    """Return a note on the run that has too few worlds for intervals, or even for words."""
    few, wanted = min(compared.arms, key=lambda arm: arm.worlds), least(compared.contrasts)
    if few.worlds >= wanted:
        return []
    what = "Intervals, and words for sizes, need" if wanted == LEAST else "Intervals need"
    words = f"; words for sizes need {LEAST}" if few.worlds < LEAST < wanted else ""
    return [
        f"{what} {wanted} worlds of each run (--seeds {wanted}): {few.name} has "
        f"{few.worlds}{words}."
    ]


def effects(compared: Comparison) -> tuple[list[str], list[list[str]]]:
    """Return the head and the rows of a table of each arm against the reference; see `_effect`."""
    reference, *others = compared.arms
    rows = [
        [arm.name, *(_effect(compared.contrast(arm, each), each) for each in compared.outcomes)]
        for arm in others
    ]
    return [f"against {reference.name}", *compared.outcomes.values()], rows


def _effect(against: Contrast, outcome: str) -> str:
    """Return an effect as text: delta over all worlds, delta within seeds, the ratio of medians,
    and the number of worlds that the effect needs."""
    within, needed = paired_text(against), needed_text(against)
    parts = [
        effect_text(against, outcome),
        f"within seeds {within}" if within else "",
        ratio_text(against),
        f"needs {needed}" if needed else "",
    ]
    return "; ".join(filter(None, parts))
