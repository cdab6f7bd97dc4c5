"""The layout of the screen: the room of each part, and its place."""

from typing import Any

import pytest
from rich.segment import Segment

from primordia.live.forms import Room
from primordia.live.scene import Scene
from primordia.live.screen import composed, joined
from tests.live.drawn import text

Size = tuple[int, int]


class Parts:
    """Parts that note their rooms. The numbers have three rows; the others fill their rooms."""

    def __init__(self, beside: bool = True, part: str = "") -> None:
        self.beside, self.part = beside, part
        self.asked: dict[str, list[Size]] = {"W": [], "n": [], "o": []}

    def screen(self, width: int, height: int, organism: bool = False) -> list[str]:
        """Return the rows of a screen."""
        draw = self._organism if organism else None
        room = Room(width, height)
        return text(composed(self.beside, self._scene, self._numbers, draw, room))

    def _filled(self, name: str, room: Room, rows: int) -> list[Any]:
        self.asked[name].append((room.width, room.height))
        return [[Segment(name * room.width)] for _ in range(rows)]

    def _scene(self, room: Room) -> Scene:
        return Scene(self._filled("W", room, room.height), "colour: line of descent", self.part)

    def _numbers(self, room: Room) -> list[Any]:
        return self._filled("n", room, min(3, room.height))

    def _organism(self, room: Room) -> list[Any]:
        return self._filled("o", room, room.height)


def test_numbers_are_beside_a_torus() -> None:
    """The 80 columns have 52 for the world, 2 between, and 26 for the numbers."""
    parts = Parts()
    rows = parts.screen(80, 24)
    assert parts.asked["W"] == [(52, 22)]
    assert parts.asked["n"] == [(80, 12), (26, 23)], "the first only counts the rows of the numbers"
    beside, alone = "W" * 52 + "  " + "n" * 26, "W" * 52
    assert rows == ["", *[beside] * 3, *[alone] * 19, "colour: line of descent"]


@pytest.mark.parametrize(("width", "beside"), [(48, True), (47, False)])
def test_a_world_with_numbers_beside_it_has_at_least_twenty_columns(
    width: int, beside: bool
) -> None:
    parts = Parts()
    parts.screen(width, 24)
    assert parts.asked["W"] == [(20, 22) if beside else (47, 18)]


@pytest.mark.parametrize(
    ("height", "numbers", "world", "legend", "space"),
    [(24, 12, 18, 1, [""]), (20, 10, 14, 1, [""]), (19, 9, 15, 1, []), (15, 7, 11, 1, []),
     (14, 7, 11, 0, []), (7, 3, 4, 0, []), (5, 3, 2, 0, [])],
)  # fmt: skip
def test_numbers_are_below_a_ring(
    height: int, numbers: int, world: int, legend: int, space: list[str]
) -> None:
    """They may have half of the rows, and at least three. A world of twelve rows has a legend.

    A screen of twenty rows has empty rows between its parts.
    """
    parts = Parts(beside=False)
    above = ["W" * 80] * world + ["colour: line of descent"] * legend
    assert parts.screen(80, height) == [*space, *above, *space, *["n" * 80] * 3]
    assert parts.asked == {"W": [(80, world)], "n": [(80, numbers)], "o": []}


def test_the_note_about_what_is_shown_takes_a_row_of_the_world() -> None:
    parts = Parts(beside=False, part="shown: the first 8 of 10 cells")
    rows = parts.screen(80, 24)
    assert parts.asked["W"] == [(80, 18), (80, 17)]
    assert rows[18:20] == ["shown: the first 8 of 10 cells", "colour: line of descent"]
    assert Parts(beside=False, part="shown: a").screen(20, 24)[19] == "colour: line of desc"


def test_an_organism_is_below_the_numbers_that_are_beside_the_world() -> None:
    """The numbers may have a third of the 23 rows."""
    parts = Parts()
    rows = parts.screen(80, 24, organism=True)
    assert parts.asked == {"W": [(52, 22)], "n": [(80, 12), (26, 7)], "o": [(26, 19)]}
    left = ["W" * 52] * 22 + [f"{'colour: line of descent':52}"]
    right = [*["n" * 26] * 3, "", *["o" * 26] * 19]
    joined = [f"{one}  {other}".rstrip() for one, other in zip(left, right, strict=True)]
    assert rows == ["", *joined]


@pytest.mark.parametrize(
    ("width", "organism", "world"),
    [(200, 64, 134), (100, 40, 58), (50, 28, 20), (49, 28, 0), (20, 20, 0)],
)
def test_an_organism_beside_its_world_has_two_fifths_of_the_width(
    width: int, organism: int, world: int
) -> None:
    """It has 28 to 64 columns. It takes the place of a world that would be too narrow."""
    parts = Parts(beside=False)
    rows = parts.screen(width, 24, organism=True)
    assert parts.asked["o"] == [(organism, 19)]
    assert parts.asked["W"] == ([(world, 18)] if world else [])
    assert rows[1] == ("W" * world + "  " if world else "") + "o" * organism
    assert rows[-4:] == ["", *["n" * width] * 3]


def test_blocks_side_by_side_are_two_columns_apart() -> None:
    left, right = ([[Segment(each)] for each in block] for block in (("abc", "d"), ("x", "y", "z")))
    assert text(joined(left, right)) == ["abc  x", "d    y", "     z"]
    assert text(joined(right, left)) == ["x  abc", "y  d", "z"]
