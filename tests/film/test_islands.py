"""Films of worlds with islands: borders, names, and the lives beside the world."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image

from primordia.film import beside, borders
from primordia.film.shape import PAPER, SIDE, shape
from primordia.habitats.archipelago import archipelago
from primordia.law.placement import Placement
from primordia.organism.reliving import panel, replay
from primordia.settings.islands import Islands
from tests.synthetic import world_of
from tests.toys import Mill, Watch

BAYS = Islands(("dune", "marsh"), (0, 4, 16))
GREY = np.full((16, 3), 150, np.uint8)


def drawn(topology: Any, islands: Islands | None) -> np.ndarray:
    form = shape(Placement(topology=topology), 16, islands)
    return form.draw(GREY[: len(form.cells)])


def test_a_world_without_islands_is_drawn_as_before() -> None:
    plain = Islands(("",), (0, 16))
    np.testing.assert_array_equal(drawn("ring", plain), drawn("ring", None))


def test_a_torus_has_a_border_below_each_band_and_its_name_beside_it() -> None:
    picture = drawn("torus4", BAYS)
    zoom = (SIDE - borders.STRIP) // 4
    top, left = (SIDE - 4 * zoom) // 2, borders.STRIP
    middle = picture[:, left + zoom // 2]
    dark = np.flatnonzero((middle[top : top + 4 * zoom] == PAPER).all(axis=1))
    assert {*range(zoom - 2, zoom + 2)} <= {*dark.tolist()}
    assert len(dark) == 4 + 4 - 1, "each cell has an edge of a pixel"
    strip = picture[:, :left].astype(int) - PAPER
    named = np.flatnonzero(strip.any(axis=(1, 2)))
    assert (named < top + zoom).any()
    assert (named > top + zoom).any()
    assert not strip[top + zoom - 10 : top + zoom + 10].any()


def test_islands_of_a_well_mixed_world_fill_whole_rows_with_their_names_to_the_left() -> None:
    """Twelve and six cells: five columns are nearest to a square, and islands fill rows of three."""
    shore = Islands(("dune", "marsh"), (0, 12, 18))
    form = shape(Placement(topology="well-mixed"), 18, shore)
    assert form.cells.tolist() == [*range(18)]
    zoom = (SIDE - borders.STRIP) // 6
    left = borders.STRIP + (SIDE - borders.STRIP - 3 * zoom) // 2
    picture = form.draw(np.repeat(GREY[:1], 18, axis=0))
    named = (picture[:, :left] != PAPER).any(axis=2)
    high, wide = np.flatnonzero(named.any(axis=1)), np.flatnonzero(named.any(axis=0))
    top = (SIDE - 6 * zoom) // 2
    assert abs(high[high < top + 4 * zoom].mean() - (top + 2 * zoom)) < zoom / 4
    assert abs(high[high > top + 4 * zoom].mean() - (top + 5 * zoom)) < zoom / 4
    assert wide[-1] >= left - 2 * borders.GAP


def test_islands_without_rows_of_their_own_have_names_beside_most_of_their_cells() -> None:
    """Seven and nine cells in rows of four: the second row is the first island's, but for a cell."""
    shore = Islands(("dune", "marsh"), (0, 7, 16))
    picture = shape(Placement(topology="well-mixed"), 16, shore).draw(GREY)
    named = (picture[:, : borders.STRIP] != PAPER).any(axis=2)
    (rows,) = np.nonzero(named.any(axis=1))
    half = (rows < SIDE / 2).nonzero()[0]
    for own, middle in ((rows[half], SIDE / 4), (np.delete(rows, half), 3 * SIDE / 4)):
        assert abs(own.mean() - middle) < 10


def test_a_ring_has_rays_at_its_borders_and_names_around_it() -> None:
    picture = drawn("ring", BAYS)
    half = SIDE // 2
    present = half - borders.STRIP - 5
    for x, y, is_border in (
        (half, half - present, True),
        (half + present, half, True),
        (half, half + present, False),
        (half - present, half, False),
    ):
        assert (picture[y, x] == PAPER).all() == is_border
    y, x = np.mgrid[:SIDE, :SIDE] - half
    outside = (picture != PAPER).any(axis=2) & (np.hypot(x, y) > half - borders.STRIP + 2)
    assert (outside & (x > 0) & (y < 0)).any(), "dune is the first quarter"
    assert (outside & (x < 0) & (y > 0)).any()


def test_names_that_are_too_long_for_their_island_are_left_out() -> None:
    paper = np.zeros((100, 100, 3), np.uint8)
    borders.name_sectors(paper, 45, Islands(("a-very-long-name" * 2, "b"), (0, 1, 99)))
    borders.name_bands(paper, 20, [("a-very-long-name", 0, 20)])
    assert 0 < np.count_nonzero(paper.any(axis=2)) < 60


class Blind(Watch):
    """A habitat that draws nothing."""


class Seen(Mill):
    """A habitat that draws its bodies."""

    rate: float | None = 50.0

    def picture(self, body: Any, action: np.ndarray) -> Image.Image:
        return Image.new("RGB", (8, 4), (255, 0, 0))


def test_a_world_can_be_filmed_with_lives_if_one_island_draws() -> None:
    shore = Islands(("dune", "marsh"), (0, 3, 8))
    some, none = archipelago([Blind(), Seen()], shore), archipelago([Blind(), Blind()], shore)
    assert replay.lacking(some) == []
    assert replay.lacking(none) == replay.lacking(Blind()) != []


def test_no_life_is_shown_while_the_oldest_lives_where_nothing_is_drawn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first organism lives in cell 0, on an island that draws nothing; the next one in cell 1."""
    lives = world_of([(0, 50, True), (1, 900, False)], until=900)
    shore = Islands(("dune", "marsh"), (0, 1, 2))
    run: Any = SimpleNamespace(habitat=archipelago([Blind(), Seen()], shore))
    asked: list[int] = []

    def pictures_of(_: Any, organism: int, world: int, count: int) -> Any:
        asked.append(organism)
        while True:
            yield Image.new("RGB", (8, 4))

    monkeypatch.setattr(beside, "pictures_of", pictures_of)
    found = list(beside.oldest(run, lives, np.arange(0, 900)))
    assert found[0].life is None
    assert found[-1].life is not None
    assert (asked, found[0].about, found[-1].about) == (
        [1],
        "the oldest by tick 0: organism 0",
        "the oldest by tick 120: organism 1",
    )


def test_panels_have_their_colours_if_one_island_has_panels(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shore = Islands(("dune", "marsh"), (0, 3, 8))
    habitat = archipelago([Blind(), Seen()], shore)
    law: Any = None
    monkeypatch.setattr(panel, "is_shown", lambda law, each: each == habitat.habitats[1])
    assert len(panel.colours(law, habitat)) == 2
    assert panel.colours(law, habitat.habitats[0]) == []
