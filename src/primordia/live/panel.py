"""The numbers of the live view, laid out for any width."""

from typing import NamedTuple

import numpy as np
from rich.segment import Segment
from rich.style import Style

from primordia.config import Config
from primordia.law.world import Cause
from primordia.live.census import Census
from primordia.live.ground import Medians
from primordia.live.paint import FAINT, Row

STRONG = Style(bold=True)
FILLED = Style(color="green")
CELL = 26
"""Smallest number of columns for one number with its name."""
SHORTEST, LONGEST = 8, 24
"""Columns of a bar; a shorter one is left out."""
TOPOLOGIES = {"ring": "on a ring", "torus4": "on a torus", "torus8": "on a torus"}


class Outlook(NamedTuple):
    """Speed and remaining time, where known."""

    organism_ticks_per_s: float | None
    seconds_left: float | None


def heading(config: Config, seconds: float, width: int) -> Row:
    """Return task, size and seeds of a run, and the seconds since its start."""
    last = config.seed + config.seeds - 1
    one = f"  seed {config.seed}, {config.cells:,} cells"
    many = f"  {config.seeds:,} worlds, seeds {config.seed} to {last}, {config.cells:,} cells each"
    size = one if config.seeds == 1 else many
    topology = TOPOLOGIES.get(config.placement.topology, "well-mixed")
    task, clock = config.task, duration(seconds)
    spare = width - len(task) - len(clock) - 2
    about = next((text for text in (f"{size} {topology}", size) if len(text) <= spare), "")
    gap = max(width - len(task) - len(about) - len(clock), 1)
    return [Segment(task, STRONG), Segment(about, FAINT), Segment(" " * gap + clock, FAINT)]


def numbers(
    census: Census,
    cells: int,
    outlook: Outlook,
    takeovers: int | None,
    ground: Medians | None,
    width: int,
) -> list[Row]:
    """Return counts in columns, and causes of death.

    Args:
        census: the counts.
        cells: number of cells of one world.
        outlook: speed and remaining time.
        takeovers: number of takeovers in all worlds; None if lines of descent are not followed.
        ground: whether good lines keep their ground; None if unknown.
        width: columns of the terminal.
    """
    worlds = len(census.tick)
    values = {
        "tick": f"{census.tick.max():,}",
        "alive": _share(int(census.alive.sum()), worlds * cells),
        "mean age": f"{census.mean_age:,.0f}",
        "births": f"{census.births.sum():,}",
        "deaths": f"{census.deaths.sum():,}",
        "oldest": f"{census.oldest:,}",
        "extinctions": f"{census.extinctions.sum():,}",
        "takeovers": "" if takeovers is None else f"{takeovers:,}",
        "children mutate": f"{ground.mutated:.0%}" if ground else "",
        "mutants as good": f"{ground.as_good:.0%}" if ground else "",
        "good lines hold": f"{ground.held:.2f}" if ground else "",
        "organism-ticks/s": with_prefix(outlook.organism_ticks_per_s),
        "time left": duration(outlook.seconds_left) if outlook.seconds_left else "",
    }
    rows = _columns({name: value for name, value in values.items() if value}, width)
    return [*rows, _causes(census, width)]


def _share(part: int, whole: int) -> str:
    if whole < 10**6:
        return f"{part:,} of {whole:,}"
    return f"{with_prefix(part)} of {with_prefix(whole)}"


def _columns(values: dict[str, str], width: int) -> list[Row]:
    """Return names and values side by side, as many in a row as fit."""
    across = min(max(width // CELL, 1), 3)
    column, gap = min(width // across, CELL + 6), 3 if across > 1 else 0
    pairs = list(values.items())
    rows = []
    for at in range(0, len(pairs), across):
        row: Row = []
        for name, value in pairs[at : at + across]:
            room = max(column - gap - len(name), len(value) + 1)
            row += [Segment(name, FAINT), Segment(f"{value:>{room}}", STRONG), Segment(" " * gap)]
        rows.append(row)
    return rows


def _causes(census: Census, width: int) -> Row:
    counts = census.deaths.sum(axis=0).tolist()
    causes = [f"{n:,} {cause.label}" for cause, n in zip(Cause, counts, strict=True) if n]
    return [Segment("died of  ", FAINT), Segment((", ".join(causes) or "nothing yet")[: width - 9])]


def saturation(census: Census, cells: int, calm_needed: int, width: int) -> Row:
    """Return a bar: how close one world is to saturation, or how many of several are saturated."""
    worlds, done = len(census.tick), int((census.saturated >= 0).sum())
    if worlds > 1:
        return _bar(done / worlds, f"{done:,} of {worlds:,} worlds saturated", width)
    if done:
        return _bar(1.0, f"saturated at tick {census.saturated[0]:,}", width)
    if census.alive[0] < cells:
        return _bar(0.0, f"saturated after {calm_needed:,} full, calm ticks", width)
    calm = min(int(census.calm[0]), calm_needed)
    return _bar(calm / calm_needed, f"full and calm for {calm:,} of {calm_needed:,} ticks", width)


def _bar(share: float, text: str, width: int) -> Row:
    length = min(width - len(text) - 2, LONGEST)
    length = length if length >= SHORTEST else 0
    filled = int(share * length)
    label = f"  {text}" if length else text
    return [
        Segment("━" * filled, FILLED),
        Segment("╌" * (length - filled), FAINT),
        Segment(label[: width - length]),
    ]


def with_prefix(value: float | None) -> str:
    """Write a number with an SI prefix, such as 12.3 M; a dash if it is unknown."""
    if value is None:
        return "-"
    power = int(np.clip(np.log10(max(value, 1)) // 3, 0, 3))
    number = value / 1000**power
    digits = 1 if power and number < 100 else 0
    return f"{number:.{digits}f} {['', 'k', 'M', 'G'][power]}".strip()


def duration(seconds: float) -> str:
    """Write a duration as 12 s, 3 min 20 s, or 2 h 5 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600:,} h {whole % 3600 // 60} min"
