"""A comparison as tables for people."""

import math
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from primordia.comparison.comparison import Arm, Comparison
from primordia.comparison.contrast import Bounds, Contrast

DIRECTIONS = {
    "first": ("earlier", "later"),
    "births": ("earlier", "later"),
    "ticks": ("earlier", "later"),
    "lifespan": ("shorter", "longer"),
    "longest": ("shorter", "longer"),
    "pace": ("fewer", "more"),
    "food": ("less", "more"),
}
"""What a smaller and a larger figure mean."""

WIDE = 1000
"""columns of text, so that no line is broken"""


def side_by_side(compared: Comparison) -> str:
    """All of it, a row a run, and what the words mean."""
    console = Console(width=WIDE, color_system=None)
    with console.capture() as captured:
        console.print(_runs(compared))
        for outcome in compared.outcomes:
            console.print(_against(compared, outcome))
    lines = [line.rstrip() for line in captured.get().splitlines()]
    text = "\n".join([*lines, *_notes(compared)])
    return text.replace("\n\n\n", "\n\n").strip()


def spread(arm: Arm, outcome: str) -> str:
    """Median, and quartiles in brackets if they differ."""
    low, middle, high = (shown(arm.measured[outcome].quantile(q)) for q in (0.25, 0.5, 0.75))
    return f"{middle} ({low} to {high})" if low != high else middle


def effect(found: Contrast, outcome: str) -> str:
    """Delta with its word and direction."""
    direction = f" {DIRECTIONS[outcome][found.delta > 0]}" if found.delta else ""
    known = f"; order known of {int(100 * found.decided)} %" if found.decided < 1 else ""
    return f"{found.delta:+.2f} {found.word}{direction}{known}"


def ratio(found: Contrast) -> str:
    """Ratio of medians with its interval."""
    low, high = map(number, found.interval)
    return f"{shown(found.ratio)} ({low} to {high})"


def shown(bounds: Bounds) -> str:
    """A figure, or what is known of it."""
    low, high = bounds
    if low == high:
        return number(low)
    if math.isinf(high):
        return f">= {number(low)}" if low else "unknown"
    return f"{number(low)}..{number(high)}"


def setting(value: Any) -> str:
    """As TOML and flags write it."""
    return "none" if value is None else str(value)


def number(value: float) -> str:
    """Three digits at least, commas between thousands."""
    if math.isinf(value):
        return "inf"
    return f"{value:,.0f}" if abs(value) >= 100 or value == round(value) else f"{value:.3g}"


def _runs(compared: Comparison) -> Table:
    """How the runs differ, and how many of their worlds saturated."""
    near = {"births": compared.births, "ticks": compared.ticks}
    within = [f"{horizon:,} {unit}" for unit, horizon in near.items() if horizon is not None]
    settings = compared.arms[0].settings
    saturated = " ".join(["saturated", *["within"] * bool(within), " and ".join(within)]).strip()
    table = _table(compared.task, *settings, "worlds", saturated)
    for arm in compared.arms:
        own = [setting(value) for value in arm.settings.values()]
        table.add_row(arm.name, *own, str(arm.worlds), str(arm.saturated))
    return table


def _against(compared: Comparison, outcome: str) -> Table:
    """One outcome of each run, and each run against the first."""
    reference, *others = compared.arms
    table = _table(
        compared.outcomes[outcome], "median (quartiles)", "delta", "ratio of medians (95 %)"
    )
    table.add_row(reference.name, spread(reference, outcome), "reference", "")
    for arm in others:
        found = compared.contrast(arm, outcome)
        table.add_row(arm.name, spread(arm, outcome), effect(found, outcome), ratio(found))
    return table


def _table(*columns: str) -> Table:
    return Table(*columns, box=box.SIMPLE_HEAD, pad_edge=False)


def _notes(compared: Comparison) -> list[str]:
    late = "Late: the last quarter of the time that all worlds have lived through."
    return [
        "Medians and intervals are over worlds. Of a world that stopped unsaturated, what is known"
        " counts.",
        *[late] * bool({"pace", "food"} & set(compared.outcomes)),
        f"A long life: {compared.age:,} ticks. Mean lifespan: ticks, in each world, up to that age"
        " (Kaplan-Meier).",
        "Delta: Cliff's; the share of pairs of worlds in which the run's figure is larger than the"
        " reference's,",
        "less the share in which it is smaller.",
    ]
