"""Drawings of worlds: the place and size of each cell, labels, legends, and the past of a ring."""

from typing import Any

import numpy as np
import pytest

from primordia.law.world import World
from primordia.live.forms import Ring, Room, Torus
from primordia.live.paint import Cells, mosaic
from primordia.live.scene import Grid, Stage, cells_of
from primordia.phylogeny.clades import Lines
from primordia.random.wide import wide
from tests.live.drawn import text
from tests.live.posed import law, old, posed

# Forms.


@pytest.mark.parametrize(
    ("form", "width", "height", "scale"),
    [
        (Ring(10), 79, 1, 7), (Ring(10), 99, 1, 8), (Ring(80), 80, 1, 1), (Ring(81), 80, 1, 0),
        (Ring(10), 80, 0, 0), (Torus(4, 6), 12, 4, 2), (Torus(4, 6), 11, 9, 1),
        (Torus(4, 6), 99, 5, 2), (Torus(4, 6), 99, 6, 3), (Torus(4, 6), 999, 99, 16),
        (Torus(4, 6), 5, 9, 0), (Torus(4, 6), 9, 1, 0),
    ],
)  # fmt: skip
def test_a_cell_is_as_wide_as_fits(form: Any, width: int, height: int, scale: int) -> None:
    """It has 8 columns at most on a ring. On a torus it is a square of half rows, at most 16 wide."""
    assert form.scale(Room(width, height)) == scale


def test_a_part_of_a_torus_is_its_first_rows_and_columns() -> None:
    cells = old(24)
    whole, nothing = Torus(4, 6).draw(cells, [], Room(9, 2))
    assert (whole, nothing) == (mosaic(np.arange(24).reshape(4, 6) * 4 + 3), "")
    pixels, note = Torus(4, 6).draw(cells, [], Room(5, 1))
    expected = mosaic(np.array([[0, 1, 2, 3, 4], [6, 7, 8, 9, 10]]) * 4 + 3)
    assert (pixels, note) == (expected, "shown: 2 x 5 of 4 x 6 cells")


def test_the_past_of_a_ring_is_below_it_with_the_latest_moment_first() -> None:
    """Seven rows have four of bars, and room for six moments."""
    past = [np.array([4 * at, 4 * at + 3]) for at in range(8)]
    drawn, _ = Ring(2).draw(old(2), past, Room(4, 7))
    assert drawn[4:] == mosaic(np.stack(past[:6]).repeat(2, axis=1)), "cells are two columns wide"
    drawn, _ = Ring(2).draw(old(2), past[:3], Room(4, 7))
    assert drawn[4:] == [*mosaic(np.stack(past[:3]).repeat(2, axis=1)), []]


@pytest.mark.parametrize(
    ("cells", "width", "height", "rows", "part"),
    [
        (3, 3, 2, ["███"] * 2, ""),
        (3, 3, 9, [*["███"] * 4, *[""] * 5], ""),
        (10, 4, 9, ["████", "████", "", "████", "████", "", "██", "██"], ""),
        (10, 4, 5, ["▇▇▇▇", "", "▇▇▇▇", "", "▇▇"], ""),
        (10, 4, 4, ["▇▇▇▇", "▇▇▇▇", "▇▇"], ""),
        (10, 4, 2, ["▇▇▇▇", "▇▇▇▇"], "shown: the first 8 of 10 cells"),
        (6, 5, 5, ["▇▇▇", "", "▇▇▇"], ""),
        (2000, 1000, 1, ["▇" * 1000], "shown: the first 1,000 of 2,000 cells"),
    ],
)
def test_many_cells_make_several_equal_skylines_of_at_most_four_rows(
    cells: int, width: int, height: int, rows: list[str], part: str
) -> None:
    drawn, note = Ring(cells).draw(old(cells), [], Room(width, height))
    assert (text(drawn), note) == (rows, part)


# Tiles.


@pytest.mark.parametrize(
    ("form", "worlds", "room", "grid"),
    [
        # Cells have 2 columns if three, four or five of these worlds are side by side.
        (Torus(4, 4), 6, Room(60, 12), Grid(3, 6, Room(16, 5), 1)),
        (Ring(20), 4, Room(64, 4), Grid(1, 4, Room(60, 1), 0)),
        (Ring(20), 4, Room(64, 3), Grid(2, 4, Room(28, 1), 0)),
        (Ring(20), 4, Room(64, 12), Grid(1, 4, Room(60, 2), 1)),
        (Ring(20), 1, Room(64, 12), Grid(1, 1, Room(60, 12), 0)),
        # Where not all worlds fit, as many are shown as fit.
        (Ring(200), 8, Room(80, 5), Grid(1, 5, Room(76, 1), 0)),
        (Ring(200), 3, Room(80, 5), Grid(1, 3, Room(76, 1), 0)),
        (Ring(30), 9, Room(69, 3), Grid(2, 6, Room(30, 1), 0)),
        (Torus(63, 64), 4, Room(80, 65), Grid(1, 1, Room(76, 65), 0)),
        (Torus(63, 64), 4, Room(80, 66), Grid(1, 2, Room(76, 32), 1)),
    ],
)  # fmt: skip
def test_tiles_are_those_with_the_largest_cells(
    form: Any, worlds: int, room: Room, grid: Grid
) -> None:
    """Beside each drawing are four columns."""
    assert Grid.of(form, worlds, 4, room) == grid


def three(**more: Any) -> World:
    """Return three rings of four cells at different ticks. The ages are 95 and 8, 95, and 10 twice."""
    return posed(
        [[1, 0, 1, 0], [0, 0, 0, 1], [1, 1, 0, 0]],
        [[5, 0, 92, 0], [0, 0, 0, 205], [0, 0, 9, 9]],
        [100, 300, 10],
        **{"seed": [9, 10, 11], "branch": [[0, 9, 1, 9], [9, 9, 9, 2], [3, 4, 9, 9]], **more},
    )


def test_each_world_has_its_seed_its_own_ages_and_its_own_mark() -> None:
    """A bar of one row has seven heights; log(9) and log(11) are about half of log(100).

    Worlds that do not fit are neither drawn nor marked. Tiles side by side are equally wide.
    """
    world = three(saturated=[-1, 250, -1])

    def scene(world: World, width: int, height: int) -> Any:
        return Stage().scene(law(4, 3), world, {}, None, Room(width, height))

    marked, plain = scene(world, 9, 3), scene(three(), 9, 3)
    assert text(marked.rows) == [" 9 ▇·▄·", "10 ···▇ ✓", "11 ▄▄··"]
    assert text(plain.rows) == [" 9 ▇·▄·", "10 ···▇", "11 ▄▄··"]
    assert marked.legend == "height: age, colour: branch of the founder, ✓: saturated"
    assert (plain.legend, plain.part) == ("height: age, colour: branch of the founder", "")
    some = scene(three(saturated=[-1, -1, 0]), 12, 2)
    assert (text(some.rows), some.part) == (text(plain.rows)[:2], "shown: the first 2 of 3 worlds")
    assert some.legend == plain.legend
    across = text(scene(world, 22, 2).rows)
    assert across == [" 9 ▇·▄·    10 ···▇ ✓  ", "11 ▄▄··    "]


def test_the_note_names_worlds_and_cells_that_do_not_fit() -> None:
    """Two rows hold two worlds. A label takes four columns, so 16 of 20 columns are cells."""
    world = posed([[1] * 40] * 3, [[0] * 40] * 3, [10] * 3)
    worlds, cells = "shown: the first 2 of 3 worlds", "shown: the first 16 of 40 cells"
    for height, note in ((2, f"{worlds}; {cells}"), (3, cells)):
        assert Stage().scene(law(40, 3), world, {}, None, Room(20, height)).part == note


def test_an_empty_row_is_below_each_tile_of_several_rows() -> None:
    rows = text(Stage().scene(law(4, 3), three(), {}, None, Room(40, 12)).rows)
    assert [number for number, row in enumerate(rows) if not row] == [3, 7, 11]
    assert [row[:3] for row in rows[:3]] == [" 9 ", "   ", "   "]


def test_cells_show_lines_of_descent_where_these_are_followed_and_branches_elsewhere() -> None:
    """Birth numbers need more than 32 bits."""
    far = 2**40
    world = three(number=[[far, 0, 1, 0], [0, 0, 0, 7], [3, 4, 0, 0]])
    followed = {0: Lines([far, 1], 2), 1: Lines([7], 2)}
    followed[0].line_of = {far: 5, 1: 6}
    lines = [cells_of(law(4, 3), world, followed.get(each), each).line for each in range(3)]
    assert np.stack(lines).tolist() == [[5, -1, 6, -1], [-1, -1, -1, 7], [3, 4, -1, -1]]
    room = Room(40, 3)
    assert Stage().scene(law(4, 3), world, followed, None, room).legend.endswith("line of descent")
    for alone, note in ((1, "line of descent"), (2, "branch of the founder")):
        assert Stage().scene(law(4, 3), world, followed, alone, room).legend.endswith(note)


# The past.


def test_a_moment_is_remembered_once_and_shown_below_the_present() -> None:
    """A ring of two cells: one organism, then the other, then both."""
    stage, of, room = Stage(), law(2), Room(2, 6)

    def at(tick: int, alive: list[int]) -> World:
        return posed([alive], [[tick, tick]], [tick], branch=[[1, 2]])

    for _ in range(2):
        scene = stage.scene(of, at(1, [1, 0]), {}, None, room)
        assert text(scene.rows)[4:] == ["", ""], "the present is not part of the past"
    stage.follow(of, at(2, [0, 1]), {}, 0)
    stage.follow(of, at(2, [0, 1]), {}, 0)
    last = stage.scene(of, at(3, [1, 1]), {}, None, room)
    newborn = np.array([[4, -1], [-1, 8]])
    assert last.rows[4:] == [*mosaic(newborn[::-1]), []]


def test_the_latest_511_moments_before_the_present_are_kept() -> None:
    stage = Stage()
    for tick in range(600):
        past = stage._remember(0, tick, Cells(np.array([tick % 64]), np.zeros(1)))
    assert [int(moment[0]) // 4 for moment in past] == [n % 64 for n in range(598, 598 - 511, -1)]


def test_each_world_has_its_own_past() -> None:
    stage, of, room = Stage(), law(4, 3), Room(4, 5)
    stage.follow(of, three(), {}, 2)
    later = three()
    later = later._replace(worlds=later.worlds._replace(tick=wide([101, 301, 11])))
    assert text(stage.scene(of, later, {}, 1, room).rows)[4] == ""
    assert stage.scene(of, later, {}, 2, room).rows[4:] == mosaic(np.array([[14, 18, -1, -1]]))


def test_a_torus_has_no_past() -> None:
    stage, of = Stage(), law(4, topology="torus4")
    world = posed([[1, 0, 0, 1]], [[0, 0, 0, 0]], [10])
    stage.follow(of, world, {}, 0)
    assert stage._past == {}
