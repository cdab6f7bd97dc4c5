"""The numbers of the live view, arranged for a terminal of any size."""

from typing import NamedTuple

import numpy as np
from rich.segment import Segment
from rich.style import Style

from primordia.config import Config
from primordia.law.world import Cause
from primordia.live.census import Census
from primordia.live.paint import FAINT, Row
from primordia.settings.islands import Islands

STRONG = Style(bold=True)
FILLED = Style(color="green")
CELL = 26
"""Smallest number of columns for one number with its name."""
MOST = 5
"""At most this many values stand side by side."""
SHORTEST, LONGEST = 8, 24
"""Least and most columns of a bar; a shorter bar is left out."""
TOPOLOGIES = {"ring": "on a ring", "torus4": "on a torus", "torus8": "on a torus"}


class Outlook(NamedTuple):
    """Speed and remaining time; None if unknown."""

    organism_ticks_per_s: float | None
    seconds_left: float | None


def heading(config: Config, pace: str, seconds: float, width: int) -> Row:
    """Return task, size and seeds of a run, its pace, and the seconds since its start."""
    last = config.seed + config.seeds - 1
    one = f"  seed {config.seed}, {config.cells:,} cells"
    many = f"  {config.seeds:,} worlds, seeds {config.seed} to {last}, {config.cells:,} cells each"
    size = one if config.seeds == 1 else many
    topology = TOPOLOGIES.get(config.placement.topology, "well-mixed")
    task, clock = config.task, ", ".join(filter(None, (pace, duration(seconds))))
    spare = width - len(task) - len(clock) - 2
    about = next((text for text in (f"{size} {topology}", size) if len(text) <= spare), "")
    gap = max(width - len(task) - len(about) - len(clock), 1)
    return [Segment(task, STRONG), Segment(about, FAINT), Segment(" " * gap + clock, FAINT)]


def numbers(
    census: Census,
    cells: int,
    outlook: Outlook,
    takeovers: int | None,
    islands: Islands | None = None,
) -> dict[str, str]:
    """Return counts by name, the most important first; unknown counts are left out.

    Args:
        census: the counts.
        cells: number of cells of one world.
        outlook: speed and remaining time.
        takeovers: number of takeovers in all worlds; None if lines of descent are not followed.
        islands: the islands of a world, if the census has counted their organisms.
    """
    worlds = len(census.tick)
    values = {
        "tick": f"{census.tick.max():,}",
        "alive": _share(int(census.alive.sum()), worlds * cells),
        "mean age": f"{census.mean_age:,.0f}",
        "births": f"{census.births.sum():,}",
        "deaths": f"{census.deaths.sum():,}",
        "oldest": f"{census.oldest:,}",
        "organism-ticks/s": with_prefix(outlook.organism_ticks_per_s),
        "time left": duration(outlook.seconds_left) if outlook.seconds_left else "",
        "takeovers": "" if takeovers is None else f"{takeovers:,}",
        "extinctions": f"{census.extinctions.sum():,}",
    }
    if islands is not None and census.by_island is not None:
        counts = zip(islands.names, census.by_island.tolist(), islands.sizes, strict=True)
        values |= {f"on {name}": _share(alive, worlds * size) for name, alive, size in counts}
    return {name: value for name, value in values.items() if value}


def panel(values: dict[str, str], census: Census, bar: Row, width: int, height: int) -> list[Row]:
    """Return names and values side by side, the causes of death, and a bar; `height` limits the rows."""
    rows = _columns(values, width)[: max(height - 2, 1)]
    return [*rows, _causes(census), bar][:height]


def _share(part: int, whole: int) -> str:
    if whole < 10**6:
        return f"{part:,} of {whole:,}"
    return f"{with_prefix(part)} of {with_prefix(whole)}"


def _columns(values: dict[str, str], width: int) -> list[Row]:
    """Return names and values side by side, as many in a row as fit."""
    across = min(max(width // CELL, 1), MOST)
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


def _causes(census: Census) -> Row:
    """Return the causes of death, the most frequent first."""
    counts = zip(census.deaths.sum(axis=0).tolist(), Cause, strict=True)
    known = sorted((each for each in counts if each[0]), reverse=True)
    text = ", ".join(f"{count:,} {cause.label}" for count, cause in known)
    return [Segment("died of  ", FAINT), Segment(text or "nothing yet")]


def saturation(census: Census, cells: int, calm_needed: int, width: int) -> Row:
    """Return a bar: how close one world is to saturation, or how many of several worlds are saturated."""
    worlds, done = len(census.tick), int((census.saturated >= 0).sum())
    if done and worlds == 1:
        return _bar(1.0, f"saturated since tick {census.saturated[0]:,}", width)
    if done:
        return _bar(done / worlds, f"{done:,} of {worlds:,} worlds saturated", width)
    calm = np.where(census.alive == cells, census.calm, 0)
    longest, name = min(int(calm.max()), calm_needed), "calm" if worlds == 1 else "calmest"
    text = f"{name}: {longest:,} of {calm_needed:,} ticks"
    return _bar(longest / calm_needed, text, width)


def _bar(share: float, text: str, width: int) -> Row:
    length = min(width - len(text) - 2, LONGEST)
    length = length if length >= SHORTEST else 0
    filled = int(share * length)
    return [
        Segment("━" * filled, FILLED),
        Segment("╌" * (length - filled), FAINT),
        Segment(f"  {text}" if length else text),
    ]


def with_prefix(value: float | None) -> str:
    """Write a number with an SI prefix, such as 12.3 M; a dash if it is unknown."""
    if value is None:
        return "-"
    power = 0
    while round(value) >= 1000 and power < 3:
        value, power = value / 1000, power + 1
    digits = 1 if power and value < 99.95 else 0
    return f"{value:.{digits}f} {['', 'k', 'M', 'G'][power]}".strip()


def duration(seconds: float) -> str:
    """Write a duration as 12 s, 3 min 20 s, or 2 h 5 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600:,} h {whole % 3600 // 60} min"
