"""Drawings of worlds: one world in the form of its places, several worlds as tiles."""

from collections import deque
from collections.abc import Callable
from itertools import zip_longest
from typing import NamedTuple

import numpy as np
from rich.segment import Segment

from primordia.law.law import Law
from primordia.law.world import World
from primordia.live.forms import Ring, Room, Torus, form_of, part_of
from primordia.live.paint import EMPTY, FAINT, Cells, Row, shades
from primordia.phylogeny.clades import Lines
from primordia.random.wide import Wide, to_host

KEPT = 512
"""number of past moments of a ring that are kept"""
BESIDE = 3
"""columns beside the drawing of a world for a space and its mark, without the digits of its seed"""


class Scene(NamedTuple):
    """A drawing with its legend."""

    rows: list[Row]
    legend: str
    part: str
    """the part of the worlds that is shown; empty if all worlds are shown"""


class Grid(NamedTuple):
    """Tiles of equal size, one for each world that is shown."""

    across: int
    shown: int
    each: Room
    """the room for the drawing of a world"""
    gap: int
    """empty rows below a tile"""

    @classmethod
    def of(cls, form: Ring | Torus, worlds: int, edge: int, room: Room) -> "Grid":
        """Return the tiles in which cells are largest; if not all worlds fit, the others are left out.

        Beside each drawing are `edge` columns for its label and mark.
        """
        found = []
        for across in range(1, min(worlds, max(room.width // (edge + 1), 1)) + 1):
            down = -(-worlds // across)
            if down <= room.height:
                grid = cls._filling(room, across, down, worlds, edge)
                found.append((form.scale(grid.each), -across, grid))
        best = max(found, key=lambda each: each[:2], default=None)
        if best is not None and best[0] > 0:
            return best[2]
        wide, high = form.least
        across = max(room.width // (wide + edge), 1)
        down = max(room.height // (high if high == 1 else high + 1), 1)
        shown = min(across * down, worlds)
        return cls._filling(room, across, -(-shown // across), shown, edge)

    @classmethod
    def _filling(cls, room: Room, across: int, down: int, shown: int, edge: int) -> "Grid":
        high = room.height // down
        gap = 1 if high > 2 and down > 1 else 0
        each = Room(max(room.width // across - edge, 1), max(high - gap, 1))
        return cls(across, shown, each, gap)


class Stage:
    """The drawings of a run's worlds. It remembers the past of rings."""

    def __init__(self) -> None:
        self._past: dict[int, deque[np.ndarray]] = {}
        self._ticks: dict[int, int] = {}

    def scene(
        self, law: Law, world: World, lines: dict[int, Lines], alone: int | None, room: Room
    ) -> Scene:
        """Draw the worlds.

        Args:
            law: the law of the run.
            world: all worlds.
            lines: lines of descent by number of the world; in worlds without them, colours show the
                branch of the founder.
            alone: the only world that is shown; None for all.
            room: the room for the drawing.
        """
        form, tick = form_of(law), to_host(world.worlds.tick)

        def draw(number: int, room: Room) -> tuple[list[Row], str]:
            cells = cells_of(law, world, lines.get(number), number)
            past = (
                self._remember(number, int(tick[number]), cells) if isinstance(form, Ring) else []
            )
            return form.draw(cells, past, room)

        if law.worlds == 1 or alone is not None:
            number = alone or 0
            rows, part = draw(number, room)
            return Scene(rows, _legend(form, number in lines), part)
        return _tiles(world, form, draw, bool(lines), room)

    def follow(self, law: Law, world: World, lines: dict[int, Lines], number: int) -> None:
        """Remember the present state of a world that is a ring."""
        if law.placement.shape(law.cells)[0] == 1:
            tick = int(to_host(world.worlds.tick)[number])
            self._remember(number, tick, cells_of(law, world, lines.get(number), number))

    def _remember(self, number: int, tick: int, cells: Cells) -> list[np.ndarray]:
        """Remember this moment of a world, and return the earlier ones, the latest first."""
        past = self._past.setdefault(number, deque(maxlen=KEPT))
        if self._ticks.get(number) != tick:
            past.appendleft(shades(cells).astype(np.int16))
            self._ticks[number] = tick
        return list(past)[1:]


def _tiles(
    world: World,
    form: Ring | Torus,
    draw: Callable[[int, Room], tuple[list[Row], str]],
    followed: bool,
    room: Room,
) -> Scene:
    """Draw worlds side by side and below each other, each with its seed and a mark if saturated."""
    seeds = to_host(world.worlds.seed).tolist()
    saturated = to_host(world.worlds.saturated).astype(np.int64) >= 0
    digits = max(len(str(seed)) for seed in seeds)
    grid = Grid.of(form, len(seeds), digits + BESIDE, room)
    tiles, parts = [], dict[str, None]()
    for number in range(grid.shown):
        drawn, part = draw(number, grid.each)
        parts[part] = None
        mark, label = " ✓" if saturated[number] else "", f"{seeds[number]:>{digits}} "
        tiles.append(_labelled(drawn, label, mark, grid))
    rows: list[Row] = []
    for at in range(0, grid.shown, grid.across):
        for row in zip_longest(*tiles[at : at + grid.across], fillvalue=[]):
            rows.append([segment for tile in row for segment in tile])
        rows += [[]] * grid.gap
    legend = _legend(form, followed)
    if saturated[: grid.shown].any():
        legend += ", ✓: saturated"
    shown = (part_of(grid.shown, len(seeds), "worlds"), *parts)
    return Scene(rows[: room.height], legend, "; ".join(filter(None, shown)))


def _labelled(drawn: list[Row], label: str, mark: str, grid: Grid) -> list[Row]:
    """Return a tile: a drawing after a label and before a mark, as wide as all tiles of the grid."""
    rows = []
    for number, row in enumerate(drawn):
        first = number == 0
        left = Segment(label if first else " " * len(label), FAINT)
        own: Row = [left, *row, Segment(mark if first else "")]
        width = grid.each.width + len(label) + 2
        rows.append(Segment.adjust_line_length(own, width) if grid.across > 1 else own)
    return rows


def _legend(form: Ring | Torus, followed: bool) -> str:
    """Return the meanings of what is drawn."""
    branch = "line of descent" if followed else "branch of the founder"
    return f"{form.age}, colour: {branch}"


def cells_of(law: Law, world: World, lines: Lines | None, number: int) -> Cells:
    """Return the cells of one world, with its lines of descent if they are followed."""
    organisms, here = world.organisms, slice(number * law.cells, (number + 1) * law.cells)
    alive = np.asarray(organisms.alive)[here]

    def read(value: Wide) -> np.ndarray:
        high, low = (np.asarray(words)[here].astype(np.int64) for words in value)
        return high << 32 | low

    line = np.full(law.cells, EMPTY)
    if lines is not None:
        line_of = lines.line_of
        line[alive] = [line_of[organism] for organism in read(organisms.number)[alive].tolist()]
    else:
        line[alive] = read(organisms.branch)[alive]
    tick = int(to_host(world.worlds.tick)[number])
    return Cells.of(line, np.where(alive, tick - read(organisms.born), 0), law.saturation_ticks)
