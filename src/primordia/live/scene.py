"""Drawings of worlds: a ring as a skyline, a torus as a picture, many worlds as strips."""

from typing import NamedTuple

import numpy as np
from rich.segment import Segment

from primordia.history.lines import Lines
from primordia.law.law import Law
from primordia.law.world import World
from primordia.live.paint import EMPTY, FAINT, Cells, Row, field, skyline, strip
from primordia.random.wide import Wide, to_host

TALLEST = 4
"""Largest number of rows of a skyline."""
WIDEST = 4
"""Largest number of columns of a cell."""


class Room(NamedTuple):
    """The room for a drawing, in characters, and its means."""

    width: int
    height: int
    letters: bool
    """whether lines of descent are letters, since the terminal has too few colours"""


class Scene(NamedTuple):
    """A drawing with its legend."""

    rows: list[Row]
    legend: str
    part: str
    """the part of the worlds that is shown; empty if all are"""


def scene(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    """Draw the worlds.

    Args:
        law: the law of the run.
        world: all worlds.
        lines: lines of descent of the first worlds; without any, colours show the founder's branch.
        room: the room for the drawing.
    """
    if law.worlds > 1:
        return _strips(law, world, lines, room)
    if law.placement.shape(law.cells)[0] > 1:
        return _picture(law, world, lines, room)
    return _skylines(law, world, lines, room)


def _skylines(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    """Draw one world as skylines below each other, the cells in order."""
    wide = min(max(room.width // law.cells, 1), WIDEST)
    letter_rows = 1 if room.letters else 0
    most = max(room.height // (1 + letter_rows), 1)
    count = min(-(-law.cells * wide // (room.width // wide * wide)), most)
    across = min(-(-law.cells // count), room.width // wide)
    shown = min(across * count, law.cells)
    gap = 1 if count > 1 else 0
    tall = min(max(room.height // count - gap - letter_rows, 1), TALLEST)
    with_gaps = count > 1 and count * (tall + letter_rows + 1) - 1 <= room.height
    cells = _cells(law, world, lines, np.arange(shown))
    rows: list[Row] = []
    for at in range(0, shown, across):
        if with_gaps and rows:
            rows.append([])
        rows += skyline(cells.take(slice(at, at + across)), wide, tall, room.letters)
    part = f"shown: the first {shown:,} of {law.cells:,} cells" if shown < law.cells else ""
    return Scene(rows, f"height: age, {_line_legend(lines, room)}", part)


def _picture(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    """Draw one world as a picture of its torus."""
    rows, columns = law.placement.shape(law.cells)
    pixels_high = room.height if room.letters else 2 * room.height
    scale = 1 if room.letters else min(room.width // columns, pixels_high // rows, WIDEST)
    scale = max(scale, 1)
    high, across = min(rows, pixels_high // scale), min(columns, room.width // scale)
    index = np.arange(high)[:, None] * columns + np.arange(across)
    drawn = field(_cells(law, world, lines, index.ravel()), across, scale, room.letters)
    part = ""
    if high * across < law.cells:
        part = f"shown: {high:,} x {across:,} of {rows:,} x {columns:,} cells"
    age = "capitals: old" if room.letters else "light: age"
    return Scene(drawn, f"{age}, {_line_legend(lines, room)}", part)


def _strips(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    """Draw a strip for each world."""
    seeds = to_host(world.worlds.seed).tolist()
    saturated = to_host(world.worlds.saturated).astype(np.int64) >= 0
    digits = len(str(seeds[-1]))
    shown = min(law.worlds, room.height)
    across = min(law.cells, max(room.width - digits - 3, 1))
    rows: list[Row] = []
    for number in range(shown):
        cells = _cells(law, world, lines, number * law.cells + np.arange(across))
        label = Segment(f"{seeds[number]:>{digits}} ", FAINT)
        mark = Segment(" ✓" if saturated[number] else "")
        rows.append([label, *strip(cells, room.letters), mark])
    parts = []
    if shown < law.worlds:
        parts.append(f"{shown:,} of {law.worlds:,} worlds")
    if across < law.cells:
        parts.append(f"{across:,} of {law.cells:,} cells of each")
    part = f"shown: the first {' and '.join(parts)}" if parts else ""
    age = "capitals: old" if room.letters else "height: age"
    return Scene(rows, f"{age}, {_line_legend(lines, room)}, ✓: saturated", part)


def _line_legend(lines: list[Lines], room: Room) -> str:
    mark = "letter" if room.letters else "colour"
    return f"{mark}: {'line of descent' if lines else 'branch of the founder'}"


def _cells(law: Law, world: World, lines: list[Lines], index: np.ndarray) -> Cells:
    """Return the cells at an index (n,) into the cells of all worlds; all must be of one world."""
    organisms = world.organisms
    alive, number = np.asarray(organisms.alive)[index], int(index[0]) // law.cells

    def read(value: Wide) -> np.ndarray:
        high, low = (np.asarray(words)[index].astype(np.int64) for words in value)
        return high << 32 | low

    line = np.full(len(index), EMPTY)
    if lines:
        line_of = lines[number].line_of
        line[alive] = [line_of[organism] for organism in read(organisms.number)[alive].tolist()]
    else:
        line[alive] = read(organisms.branch)[alive]
    tick = int(to_host(world.worlds.tick)[number])
    return Cells.of(line, np.where(alive, tick - read(organisms.born), 0), law.saturation_ticks)
