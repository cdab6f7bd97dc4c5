"""The parts of the screen in rows: the world, numbers below or beside it, one organism."""

from collections.abc import Callable
from itertools import zip_longest

from rich.segment import Segment

from primordia.live.forms import Room
from primordia.live.paint import FAINT, Row
from primordia.live.panel import CELL
from primordia.live.scene import Scene

GAP = 2
"""columns between two parts side by side"""
NARROWEST, BROADEST = 28, 64
"""smallest and largest number of columns of an organism beside its world"""
SCENE = 20
"""fewest columns of a world with something beside it"""
SPACED = 20
"""least number of rows of a screen that has empty rows between its parts"""
LOW = 12
"""least number of rows of a screen that has a legend"""

Draw = Callable[[Room], list[Row]]
"""Function that draws a part of the screen into a room, a rectangle; it returns no more rows than fit."""


def composed(
    beside: bool,
    draw: Callable[[Room], Scene],
    numbers: Draw,
    organism: Draw | None,
    room: Room,
) -> list[Row]:
    """Return the rows of a screen.

    Args:
        beside: whether numbers go beside the world, if it is wide enough, and not below it.
        draw: draws the worlds.
        numbers: draws the numbers.
        organism: draws the organism that is shown; None if no organism is shown.
        room: the whole room.
    """
    space = 1 if room.height >= SPACED else 0
    below = numbers(room._replace(height=max(room.height // 2, 3)))
    stacked = room._replace(height=max(room.height - len(below) - 2 * space, 1))
    side = room._replace(width=room.width - CELL - GAP, height=max(room.height - space, 1))
    if beside and side.width >= SCENE:
        left = _scene(draw, side)
        width = room.width - max(map(Segment.get_line_length, left), default=0) - GAP
        column = room._replace(width=width, height=side.height)
        return [[]] * space + joined(left, _column(numbers, organism, column))
    if organism is None:
        return [[]] * space + _scene(draw, stacked) + [[]] * space + below
    width = min(max(room.width * 2 // 5, NARROWEST), BROADEST, room.width)
    above = organism(stacked._replace(width=width))
    if (left_over := room.width - width - GAP) >= SCENE:
        above = joined(_scene(draw, stacked._replace(width=left_over)), above)
    return [[]] * space + above + [[]] * space + below


def _column(numbers: Draw, organism: Draw | None, room: Room) -> list[Row]:
    """Return numbers, and an organism below them."""
    if organism is None:
        return numbers(room)
    above = numbers(room._replace(height=room.height // 3))
    left = room._replace(height=room.height - len(above) - 1)
    return [*above, [], *organism(left)]


def _scene(draw: Callable[[Room], Scene], room: Room) -> list[Row]:
    """Return the worlds with their legend, where there is room for it."""
    worlds = room._replace(height=room.height - (1 if room.height >= LOW else 0))
    drawn = draw(worlds)
    if drawn.part:
        drawn = draw(worlds._replace(height=max(worlds.height - 1, 1)))
    legend = [drawn.part] if drawn.part else []
    if room.height >= LOW:
        legend.append(drawn.legend)
    return [*drawn.rows, *([Segment(each[: room.width], FAINT)] for each in legend)]


def joined(left: list[Row], right: list[Row]) -> list[Row]:
    """Return two blocks of rows side by side."""
    width = max(map(Segment.get_line_length, left), default=0) + GAP
    empty: Row = []
    both = zip_longest(left, right, fillvalue=empty)
    pad = Segment.adjust_line_length
    return [[*pad(one, width), *other] if other else one for one, other in both]
