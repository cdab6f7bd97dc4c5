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
    assert rows[0] == ""
    assert rows[1:4] == ["W" * 52 + "  " + "n" * 26] * 3
    assert rows[4:23] == ["W" * 52] * 19
    assert rows[23:] == ["colour: line of descent"]


def test_numbers_are_below_a_ring() -> None:
    parts = Parts(beside=False)
    rows = parts.screen(80, 24)
    assert parts.asked["W"] == [(80, 18)]
    assert rows == ["", *["W" * 80] * 18, "colour: line of descent", "", *["n" * 80] * 3]


@pytest.mark.parametrize(("width", "beside"), [(48, True), (47, False)])
def test_a_world_with_numbers_beside_it_has_at_least_twenty_columns(
    width: int, beside: bool
) -> None:
    parts = Parts()
    parts.screen(width, 24)
    assert parts.asked["W"] == [(20, 22) if beside else (47, 18)]


@pytest.mark.parametrize(("height", "spaces"), [(20, 1), (19, 0)])
def test_empty_rows_are_between_the_parts_of_a_screen_of_twenty_rows(
    height: int, spaces: int
) -> None:
    rows = Parts(beside=False).screen(80, height)
    assert [row for row in rows if not row] == [""] * 2 * spaces
    assert len(rows) == height


@pytest.mark.parametrize(("height", "legend"), [(15, True), (14, False)])
def test_a_world_of_twelve_rows_has_a_legend(height: int, legend: bool) -> None:
    """Three rows are numbers."""
    rows = Parts(beside=False).screen(80, height)
    assert rows[:-3] == ["W" * 80] * 11 + ["colour: line of descent"] * legend


@pytest.mark.parametrize(("height", "rows"), [(24, 12), (9, 4), (7, 3), (6, 3), (5, 3), (3, 3)])
def test_numbers_below_a_world_have_half_of_the_rows_and_at_least_three(
    height: int, rows: int
) -> None:
    parts = Parts(beside=False)
    parts.screen(80, height)
    assert parts.asked["n"] == [(80, rows)]


def test_the_note_about_what_is_shown_takes_a_row_of_the_world() -> None:
    parts = Parts(beside=False, part="shown: the first 8 of 10 cells")
    rows = parts.screen(80, 24)
    assert parts.asked["W"] == [(80, 18), (80, 17)]
    assert rows[1:20] == [
        *["W" * 80] * 17, "shown: the first 8 of 10 cells", "colour: line of descent",
    ]  # fmt: skip
    assert Parts(beside=False, part="shown: a").screen(20, 24)[19] == "colour: line of desc"


def test_an_organism_is_below_the_numbers_that_are_beside_the_world() -> None:
    parts = Parts()
    rows = parts.screen(80, 24, organism=True)
    assert parts.asked["n"][1:] == [(26, 7)], "a third of the 23 rows"
    assert parts.asked["o"] == [(26, 19)]
    assert rows[1:4] == ["W" * 52 + "  " + "n" * 26] * 3
    assert rows[4] == "W" * 52
    assert rows[5:] == ["W" * 52 + "  " + "o" * 26] * 18 + [
        f"{'colour: line of descent':54}{'o' * 26}"
    ]


@pytest.mark.parametrize(
    ("width", "organism"), [(200, 64), (160, 64), (100, 40), (70, 28), (60, 28), (50, 28)]
)
def test_an_organism_beside_its_world_has_two_fifths_of_the_width(
    width: int, organism: int
) -> None:
    """It has 28 to 64 columns. The world has the rest."""
    parts = Parts(beside=False)
    rows = parts.screen(width, 24, organism=True)
    assert parts.asked["o"] == [(organism, 19)]
    world = width - organism - 2
    assert parts.asked["W"] == [(world, 18)]
    assert rows[1] == "W" * world + "  " + "o" * organism
    assert rows[-4:] == ["", *["n" * width] * 3]


@pytest.mark.parametrize(("width", "organism"), [(49, 28), (40, 28), (20, 20)])
def test_an_organism_takes_the_place_of_a_world_that_would_be_too_narrow(
    width: int, organism: int
) -> None:
    parts = Parts(beside=False)
    rows = parts.screen(width, 24, organism=True)
    assert parts.asked["W"] == []
    assert rows == ["", *["o" * organism] * 19, "", *["n" * width] * 3]


def test_blocks_side_by_side_are_two_columns_apart() -> None:
    left, right = ([[Segment(each)] for each in block] for block in (("abc", "d"), ("x", "y", "z")))
    assert text(joined(left, right)) == ["abc  x", "d    y", "     z"]
    assert text(joined(right, left)) == ["x  abc", "y  d", "z"]
