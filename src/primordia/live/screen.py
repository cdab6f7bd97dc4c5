"""The parts of the screen in rows: the world, numbers below or beside it, one organism."""

from collections.abc import Callable
from itertools import zip_longest

from rich.segment import Segment

from primordia.live.forms import Room
from primordia.live.paint import FAINT, Row, padded, width_of
from primordia.live.panel import CELL, fitting
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
    measure: Callable[[Room], int],
    draw: Callable[[Room], Scene],
    numbers: Draw,
    organism: Draw | None,
    room: Room,
) -> list[Row]:
    """Return the rows of a screen.

    Numbers go beside the world, or below it if that makes the cells larger.

    Args:
        measure: returns the width of the worlds' cells in a room, in columns; 0 if not all cells fit.
        draw: draws the worlds.
        numbers: draws the numbers.
        organism: draws the organism that is shown; None if no organism is shown.
        room: the whole room.
    """
    space = 1 if room.height >= SPACED else 0
    below = numbers(room._replace(height=max(room.height // 2, 3)))
    stacked = room._replace(height=max(room.height - len(below) - 2 * space, 1))
    side = room._replace(width=room.width - CELL - GAP, height=max(room.height - space, 1))
    sizes = [_size(measure, each) for each in (side, stacked)]
    if side.width >= SCENE and sizes[0] >= sizes[1]:
        left = _scene(draw, side)
        width = room.width - max(map(width_of, left), default=0) - GAP
        column = room._replace(width=width, height=side.height)
        return [[]] * space + joined(left, _column(numbers, organism, column))
    if organism is None:
        return [[]] * space + _scene(draw, stacked) + [[]] * space + below
    width = min(max(room.width * 2 // 5, NARROWEST), BROADEST, room.width)
    beside = organism(stacked._replace(width=width))
    if room.width - width - GAP < SCENE:
        above = beside
    else:
        above = joined(_scene(draw, stacked._replace(width=room.width - width - GAP)), beside)
    return [[]] * space + above + [[]] * space + below


def _size(measure: Callable[[Room], int], room: Room) -> tuple[int, int]:
    """Return the size of a cell, and the size of the room if not all cells fit."""
    scale = measure(_drawn(room))
    return scale, 0 if scale else room.width * room.height


def _column(numbers: Draw, organism: Draw | None, room: Room) -> list[Row]:
    """Return numbers, and an organism below them."""
    if organism is None:
        return numbers(room)
    above = numbers(room._replace(height=room.height // 3))
    left = room._replace(height=room.height - len(above) - 1)
    return [*above, [], *organism(left)]


def _drawn(room: Room) -> Room:
    """Return the room for the worlds themselves, without legend."""
    return room._replace(height=room.height - (1 if room.height >= LOW else 0))


def _scene(draw: Callable[[Room], Scene], room: Room) -> list[Row]:
    """Return the worlds with their legend, where there is room for it."""
    drawn = draw(_drawn(room))
    if drawn.part:
        drawn = draw(_drawn(room)._replace(height=max(_drawn(room).height - 1, 1)))
    legend = [[drawn.part]] if drawn.part else []
    if room.height >= LOW:
        legend.append([drawn.legend, drawn.legend.replace(" of descent", "")])
    return [*drawn.rows, *([Segment(fitting(each, room.width), FAINT)] for each in legend)]


def joined(left: list[Row], right: list[Row]) -> list[Row]:
    """Return two blocks of rows side by side."""
    width = max(map(width_of, left), default=0) + GAP
    empty: Row = []
    both = zip_longest(left, right, fillvalue=empty)
    return [[*padded(one, width), *other] if other else one for one, other in both]
