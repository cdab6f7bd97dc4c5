"""What the pictures of a film show."""

import numpy as np
import pytest
from PIL import Image

from primordia.errors import InputError
from primordia.figures import spacetime
from primordia.film import colours as colouring
from primordia.film import shape as shapes
from primordia.film.colours import FADING, FLASH, GROUND, PALETTE, colours
from primordia.film.frame import HEIGHT, STRIPS, WIDTH, Frames, cell_colours
from primordia.film.moments import RATE, SECONDS, moments
from primordia.film.shape import PAPER, SIDE, shape
from primordia.law.placement import Placement
from primordia.organism import video
from primordia.phylogeny.clades import clades_of
from tests.synthetic import alive, world_of

LIVED = [(0, 9, True), (2, 30, False), (2, 4, True), (5, 30, False), (11, 1, True)]
FULL = 20


def test_a_cell_fades_after_death() -> None:
    world, ticks = world_of(LIVED, until=40), np.arange(12, 40)
    drawn = np.array(list(colours(world, world.cell.astype(np.int64), ticks, FULL)), float)
    dying = int(world.ended[world.died].max()) - 12
    row = int(np.argmax(np.where(world.died, world.ended, 0)))
    left = FADING ** np.arange(1, len(ticks) - dying + 1)
    expected = GROUND + left[:, None] * (drawn[dying - 1, row] - GROUND)
    np.testing.assert_allclose(drawn[dying:, row], expected, atol=1.5)
    assert (drawn[0, world.ended < 12] == GROUND).all()


@pytest.mark.parametrize("together", [1, 10**6])
def test_a_cell_is_lighter_with_age_and_flashes_after_a_birth(
    together: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half of the 40 cells are always empty. A flash is weaker if more cells have a newborn. There is no
    flash if a quarter of the cells have one."""
    monkeypatch.setattr(colouring, "MOST", together)
    lived = [(tick // 3 * 3, tick, tick % 3 > 0) for tick in range(14)] + [(20, 60, False)] * 6
    world, cells = world_of(lived, until=90), np.arange(40)
    clades = clades_of(world)
    ticks = np.array([2, 3, 6, 7, 13, 20, 30, 41, 80])
    for number, drawn in enumerate(colours(world, cells, ticks, FULL)):
        tick, before = ticks[number], ticks[max(number - 1, 0)]
        living = [row for row in range(20) if alive(world, row, tick)]
        new = [row for row in living if world.born[row] > before]
        flash = FLASH * max(1 - 4 * len(new) / 40, 0)
        for row in living:
            light = min(np.log1p(tick - world.born[row]) / np.log1p(FULL), 1)
            (code,) = spacetime.line_codes(world, clades, np.array([[row]]), np.array([tick]))[0]
            expected = PALETTE[code % len(PALETTE)] * (1 + light) / 2
            expected += (flash if row in new else 0) * (255 - expected)
            np.testing.assert_allclose(drawn[row], expected, atol=1)
        assert (drawn[20:] == GROUND).all()


def test_a_torus_is_drawn_cell_for_cell() -> None:
    form = shape(Placement(topology="torus4", rows=3), 12)
    seen = np.arange(36, dtype=np.uint8).reshape(12, 3) + 100
    picture = form.draw(seen[form.cells])
    zoom = SIDE // 4
    top = (SIDE - 3 * zoom) // 2
    for cell in range(12):
        row, column = divmod(cell, 4)
        middle = picture[top + row * zoom + zoom // 2, column * zoom + zoom // 2]
        np.testing.assert_array_equal(middle, seen[cell])
    assert (picture[: top - 1] == PAPER).all()


def test_a_well_mixed_world_is_a_square() -> None:
    form = shape(Placement(topology="well-mixed"), 10)
    picture = form.draw(np.full((len(form.cells), 3), 200, np.uint8))
    # Each cell has a dark edge of one pixel above and on its left.
    assert (picture == 200).all(axis=2).sum() == 10 * (SIDE // 4 - 1) ** 2


def test_large_rings_are_drawn_in_part() -> None:
    for cells, step in ((1_024, 1), (1_025, 2), (2_048, 2), (2_049, 3)):
        assert shape(Placement(), cells).cells.tolist() == list(range(0, cells, step))


def test_the_longer_side_of_a_torus_decides_which_cells_are_drawn() -> None:
    """The torus has 1,000 rows of 2 cells. The picture has every third row, and the first column."""
    long = shape(Placement(topology="torus4", rows=1000), 2000)
    assert long.cells.tolist() == [6 * row for row in range(334)]
    flat = shape(Placement(topology="torus4", rows=2), 8)
    assert flat.cells.tolist() == list(range(8))
    wide = shape(Placement(topology="torus4", rows=2), 2000)
    assert wide.cells.tolist() == [3 * column for column in range(334)]
    picture = flat.draw(np.full((8, 3), 200, np.uint8))
    assert (picture == 200).all(axis=2).any(axis=1).sum() == 2 * (SIDE // 4 - 1)


def test_a_ring_has_the_present_outside_and_its_past_within() -> None:
    ring = shape(Placement(), 4)
    first, then = np.zeros((4, 3), np.uint8), np.zeros((4, 3), np.uint8)
    first[0], then[0] = (200, 0, 0), (0, 200, 0)
    ring.draw(first)
    for _ in range(19):
        picture = ring.draw(then)
    # Cell 0 of four is the quarter on the right above; the diagonal is its middle.
    radii = np.arange(SIDE // 2)
    diagonal = (radii / np.sqrt(2)).astype(int)
    seen = picture[SIDE // 2 - 1 - diagonal, SIDE // 2 + diagonal]
    outer = int(SIDE // 2 * (1 - shapes.NOW))
    assert (seen[outer + 1 : -2] == then[0]).all()
    assert (seen[outer - 17 : outer - 1] == then[0]).all()
    assert (seen[outer - 19] == first[0]).all()
    assert (seen[outer - 23] == GROUND.astype(np.uint8)).all()


def test_the_innermost_ring_is_the_earliest_moment_that_has_room(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In a picture of 48 pixels, the past is 15.4 pixels wide, so 16 moments are seen."""
    monkeypatch.setattr(shapes, "SIDE", 48)
    ring, moments_seen = shape(Placement(), 4), 16
    first, then = np.full((4, 3), (200, 0, 0), np.uint8), np.full((4, 3), (0, 200, 0), np.uint8)
    pictures = [ring.draw(colour) for colour in [first] + [then] * moments_seen]
    left = [int((picture == first[0]).all(axis=2).sum()) for picture in pictures]
    assert left[-2] > 0
    assert left[-1] == 0


@pytest.mark.parametrize(("side", "edge"), [(120, 1), (160, 0)])
def test_cells_of_four_pixels_have_an_edge_and_smaller_ones_have_none(side: int, edge: int) -> None:
    form = shape(Placement(topology="torus4", rows=side), side**2)
    picture = form.draw(np.full((side**2, 3), 200, np.uint8))
    pixels = SIDE // side - edge
    assert (picture == 200).all(axis=2).sum() == (side * pixels) ** 2


def test_a_film_by_births_has_900_moments_of_birth_at_most() -> None:
    lived = [(born, 5, True) for born in range(1, 2_000)] + [(2_000, 0, False)]
    world = world_of(lived, until=2_100)
    shown = moments(world, 0, "births", (None, None))
    assert len(shown) == RATE * SECONDS + 2
    assert shown[[0, 1, -2, -1]].tolist() == [0, 1, 2_000, 2_100]
    assert set(np.diff(shown[1:-1])) == {2, 3}


def test_moments_pass_by_births_or_by_ticks() -> None:
    world = world_of([(born**2, 5, born > 0) for born in range(40)], until=2_000)
    by_births = moments(world, 0, "births", (None, None))
    assert set(by_births) == {0, *world.born.tolist(), 2_000}
    by_ticks = moments(world, 0, "ticks", (100, 2_000))
    assert (by_ticks[0], by_ticks[-1], len(by_ticks)) == (100, 2_000, RATE * SECONDS)
    assert set(np.diff(by_ticks)) == {2, 3}
    assert moments(world, 0, "births", (9, 16)).tolist() == [9, 16], "the birth at 9 is before"
    assert moments(world, 0, "births", (10, 26)).tolist() == [10, 16, 25, 26]
    assert moments(world, 0, "births", (15, 16)).tolist() == [15, 16], "the birth at 16 is the last"
    with pytest.raises(InputError, match="nothing was born from tick 1521 to 1600"):
        moments(world, 0, "births", (39**2, 1_600))
    assert moments(world, 100, "ticks", (None, None))[[0, -1]].tolist() == [100, 2_000]
    for ticks in ((-1, None), (None, 2_001), (50, 50), (None, 0)):
        with pytest.raises(InputError, match="can be shown from tick 0 to 2000"):
            moments(world, 0, "ticks", ticks)
    with pytest.raises(InputError, match="from tick 100 to 2000, not from 0 to 2000"):
        moments(world, 100, "ticks", (0, None))
    with pytest.raises(InputError, match="nothing was born from tick 1700 to 1800"):
        moments(world, 0, "births", (1_700, 1_800))


def test_a_picture_has_the_share_that_has_passed() -> None:
    world = np.full((SIDE, SIDE, 3), 90, np.uint8)
    picture = np.asarray(Frames("a task", alone=False).draw(world, "tick 1", 0.25, None, ""))
    assert picture.shape == (HEIGHT, WIDTH, 3)
    bar = (picture[-10:] != PAPER).any(axis=2)
    assert bar[-1].sum() == pytest.approx(WIDTH / 4, abs=1)
    assert bar[:, : WIDTH // 4].all(axis=1).tolist() == [False] * 7 + [True] * 3
    assert not bar[:7].any()


def test_a_picture_has_nothing_of_the_one_before_it() -> None:
    worlds = [np.full((SIDE, SIDE, 3), light, np.uint8) for light in (90, 140)]
    life, frames = Image.new("RGB", (40, 10), "red"), Frames("a task", alone=False)
    frames.draw(worlds[0], "tick 1,000   births 90", 1.0, life, "organism 1,000")
    then = frames.draw(worlds[1], "tick 2", 0.25, None, "")
    fresh = Frames("a task", alone=False).draw(worlds[1], "tick 2", 0.25, None, "")
    np.testing.assert_array_equal(np.asarray(then), np.asarray(fresh))


def test_a_picture_has_its_words_and_the_life_in_their_places() -> None:
    """The title is above, the counts are below on the left, and the words about a life on the right."""
    world, life = np.full((SIDE, SIDE, 3), 90, np.uint8), Image.new("RGB", (40, 10), "red")

    def drawn(title: str, counts: str, about: str, alone: bool = False) -> np.ndarray:
        frames = Frames(title, alone)
        return np.asarray(frames.draw(world, counts, 0.5, None if alone else life, about))

    empty = drawn("", "", "")
    left, right, below = slice(0, WIDTH // 2), slice(WIDTH // 2, WIDTH), slice(48 + SIDE, HEIGHT)
    above = slice(0, 48)
    for words, (down, across) in (
        (("a task", "", ""), (above, left)),
        (("", "tick 1", ""), (below, left)),
        (("", "", "organism 1"), (below, right)),
    ):
        changed = (drawn(*words) != empty).any(axis=2)
        assert 0 < changed.sum() == changed[down, across].sum(), words
    red = np.argwhere((empty == (255, 0, 0)).all(axis=2))
    assert red[:, 0].mean() == pytest.approx(48 + SIDE / 2, abs=1), "in the middle of its height"
    assert red[:, 1].min() == 2 * 20 + SIDE
    assert red[:, 1].max() == WIDTH - 20 - 1
    grey = np.argwhere((empty == 90).all(axis=2))
    assert grey.min(axis=0).tolist() == [48, 20]
    alone = np.argwhere((drawn("", "", "", alone=True) == 90).all(axis=2))
    assert alone.min(axis=0).tolist() == [48, (WIDTH - SIDE) // 2]


def test_the_colours_of_a_gif_have_each_hue_dark_middle_and_light() -> None:
    seen = np.asarray(video.sample_of(Image.new("RGB", (960, 576)), cell_colours()))
    assert seen.shape == (2 * 144, 240, 3)
    assert not seen[:144].any(), "the picture itself is above"
    high = 144 // STRIPS
    rows = [seen[144 + high * number + high // 2].astype(float) for number in range(STRIPS)]
    for row, light in zip(rows, (0.5, 0.75, 1.0), strict=True):
        np.testing.assert_allclose(row, light * rows[2], atol=1)
    assert len(np.unique(rows[2], axis=0)) > 30
