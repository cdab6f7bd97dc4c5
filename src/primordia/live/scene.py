"""What is drawn of the worlds: a ring as a skyline, a torus as a picture, many worlds as strips."""

from typing import NamedTuple

import numpy as np
from rich.segment import Segment

from primordia.history.lines import Lines
from primordia.law.law import Law
from primordia.law.world import World
from primordia.live.paint import EMPTY, FAINT, Cells, Row, field, skyline, strip
from primordia.random.wide import Wide, to_host

TALLEST = 4
"""rows of a skyline"""
WIDEST = 4
"""columns of a cell"""


class Room(NamedTuple):
    """How much may be drawn, in characters, and with what."""

    width: int
    height: int
    letters: bool
    """whether colours cannot be told apart, or are not wanted"""


class Scene(NamedTuple):
    """Rows, and below them what they mean."""

    rows: list[Row]
    legend: str
    part: str
    """what is not drawn; empty if all is"""


def scene(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    """Draw the worlds. `lines`: of the first worlds, as many as are followed; none: by branch."""
    if law.worlds > 1:
        return _strips(law, world, lines, room)
    if law.placement.shape(law.cells)[0] > 1:
        return _picture(law, world, lines, room)
    return _skylines(law, world, lines, room)


def _skylines(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    wide = min(max(room.width // law.cells, 1), WIDEST)
    own = 1 + room.letters
    each = max(room.height // own, 1)
    strips = min(-(-law.cells * wide // (room.width // wide * wide)), each)
    across = min(-(-law.cells // strips), room.width // wide)
    shown = min(across * strips, law.cells)
    gap = int(strips > 1)
    tall = min(max(room.height // strips - gap - room.letters, 1), TALLEST)
    gap = gap * (strips * (tall + room.letters + 1) - 1 <= room.height)
    cells = _cells(law, world, lines, np.arange(shown))
    rows: list[Row] = []
    for at in range(0, shown, across):
        rows += [[]] * (gap * bool(rows))
        rows += skyline(cells.take(slice(at, at + across)), wide, tall, room.letters)
    part = f"shown: the first {shown:,} of {law.cells:,} cells" * (shown < law.cells)
    return Scene(rows, f"height: age, {_telling(lines, room)}", part)


def _picture(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    rows, columns = law.placement.shape(law.cells)
    lines_high = room.height if room.letters else 2 * room.height
    scale = 1 if room.letters else min(room.width // columns, lines_high // rows, WIDEST)
    scale = max(scale, 1)
    high, across = min(rows, lines_high // scale), min(columns, room.width // scale)
    index = np.arange(high)[:, None] * columns + np.arange(across)
    drawn = field(_cells(law, world, lines, index.ravel()), across, scale, room.letters)
    part = f"shown: {high:,} x {across:,} of {rows:,} x {columns:,} cells" * (
        high * across < law.cells
    )
    age = "capitals: old" if room.letters else "light: age"
    return Scene(drawn, f"{age}, {_telling(lines, room)}", part)


def _strips(law: Law, world: World, lines: list[Lines], room: Room) -> Scene:
    seeds = to_host(world.worlds.seed).tolist()
    done = to_host(world.worlds.saturated).astype(np.int64) >= 0
    digits = len(str(seeds[-1]))
    shown = min(law.worlds, room.height)
    across = min(law.cells, max(room.width - digits - 3, 1))
    rows: list[Row] = []
    for each in range(shown):
        cells = _cells(law, world, lines, each * law.cells + np.arange(across))
        label = Segment(f"{seeds[each]:>{digits}} ", FAINT)
        rows.append([label, *strip(cells, room.letters), Segment(" ✓" * int(done[each]))])
    parts = [f"{shown:,} of {law.worlds:,} worlds"] * (shown < law.worlds)
    parts += [f"{across:,} of {law.cells:,} cells of each"] * (across < law.cells)
    part = f"shown: the first {' and '.join(parts)}" * bool(parts)
    age = "capitals: old" if room.letters else "height: age"
    return Scene(rows, f"{age}, {_telling(lines, room)}, ✓: saturated", part)


def _telling(lines: list[Lines], room: Room) -> str:
    how = "letter" if room.letters else "colour"
    return f"{how}: {'line of descent' if lines else 'branch of the founder'}"


def _cells(law: Law, world: World, lines: list[Lines], index: np.ndarray) -> Cells:
    """Those at an index (n,) into the cells of all worlds; all are of one world."""
    organisms = world.organisms
    alive, of = np.asarray(organisms.alive)[index], int(index[0]) // law.cells

    def count(value: Wide) -> np.ndarray:
        high, low = (np.asarray(words)[index].astype(np.int64) for words in value)
        return high << 32 | low

    line = np.full(len(index), EMPTY)
    if lines:
        line[alive] = [
            lines[of].line_of[number] for number in count(organisms.number)[alive].tolist()
        ]
    else:
        line[alive] = count(organisms.branch)[alive]
    tick = int(to_host(world.worlds.tick)[of])
    return Cells.of(line, np.where(alive, tick - count(organisms.born), 0), law.saturation_ticks)
