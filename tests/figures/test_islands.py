"""Figures of islands: lives after transplants, generalists, islands over time, borders."""

from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgb
from matplotlib.text import Annotation

from primordia.assays.generalists import Ancestor, Generalists
from primordia.assays.transplant import Transplant
from primordia.figures import assays, islands, spacetime, style
from primordia.history import series
from primordia.runs.lives import Lives
from primordia.settings.islands import Islands
from tests.figures.reading import axes_of, key, labels, lines, points, run_of, ticks
from tests.synthetic import alive, world_of, worlds_of

NAMES = ("dune", "marsh")
SHORE: dict[str, Any] = {
    "cells": 8,
    "habitat": {"islands": [{"name": "dune"}, {"name": "marsh", "share": 3.0}]},
}
LIVED = [(0, 60, False), (2, 30, True), (5, 90, False), (7, 9, True), (9, 3, True), (20, 70, False)]


def test_lives_after_transplants_are_numbers_in_colours_with_homes_framed() -> None:
    lived = np.array([[100.0, 10], [50, 20], [5, 5]])
    found = [
        Transplant(world, NAMES, (4, 4), lived * scale) for world, scale in enumerate((1, 3, 2))
    ]
    heat, ratios = axes_of(assays.transplant, found)
    written = {text.get_position(): text.get_text() for text in heat.texts}
    for (row, column), value in np.ndenumerate(2 * lived):
        assert written[column, row] == f"{value:,.0f}"
    assert ticks(heat.xaxis) == dict(enumerate(NAMES))
    assert ticks(heat.yaxis) == dict(enumerate([*NAMES, "founders"]))
    frames = [patch for patch in heat.patches if to_hex(patch.get_edgecolor()) == style.VERMILION]
    middles = [np.mean(patch.get_extents().get_points(), axis=0) for patch in frames]
    places = [heat.transData.inverted().transform(middle) for middle in middles]
    np.testing.assert_allclose(places, [(0, 0), (1, 1)], atol=0.01)
    assert labels(heat)[0] == "Ticks lived, median of 3 worlds"
    medians = {y: x for x, y in points(ratios, style.BLUE) if y in (0.17, 1.17)}
    assert medians == {0.17: 2, 1.17: 2}, "local against foreign"
    away = {y: x for x, y in points(ratios, style.SKY) if y in (-0.17, 0.83)}
    assert away == {-0.17: 10, 0.83: pytest.approx(0.4)}
    assert key(ratios) == {"home / away": style.SKY, "local / foreign": style.BLUE}
    low, high = ratios.get_xlim()
    assert low * high == pytest.approx(1)
    assert high > 10


def test_an_island_without_natives_has_dashes() -> None:
    lived = np.array([[100.0, 10], [np.nan, np.nan], [5, 5]])
    heat, ratios = axes_of(assays.transplant, [Transplant(0, NAMES, (4, 0), lived)])
    assert [text.get_text() for text in heat.texts[2:4]] == ["-", "-"]
    assert labels(heat)[0] == "Ticks lived"
    assert points(ratios, style.BLUE) == []


def a_line(*lived: tuple[float, float]) -> tuple[Ancestor, ...]:
    """Return ancestors of every second generation; an island is mastered from 10 ticks on."""
    return tuple(
        Ancestor(
            2 * at, at, at, "mutant", "dune", each,
            tuple(name for name, ticks in zip(NAMES, each, strict=True) if ticks > 10),
        )
        for at, each in enumerate(lived)
    )  # fmt: skip


def test_generalists_are_drawn_by_home_and_their_line_by_island() -> None:
    found = Generalists(
        3, NAMES, np.arange(4), np.array([0, 0, 1, 1]),
        np.array([[1.0, 2], [50, 2], [50, 90], [60, 90]]), np.array([10.0, 10]),
        a_line((20, 1), (5, 2), (30, 3), (40, 50)),
    )  # fmt: skip
    shares, line = axes_of(assays.generalists, [found])
    drawn: list[Any] = list(shares.patches)
    bars = [(bar.get_x() + 0.35, bar.get_y(), bar.get_height()) for bar in drawn]
    heights = {(round(x), y): height for x, y, height in bars if height}
    assert heights == {(0, 0): 0.25, (1, 0): 0.25, (2, 0): 0.5}
    dune, marsh = style.island_colours(NAMES).values()
    for colour, lived in ((dune, [20, 5, 30, 40]), (marsh, [1, 2, 3, 50])):
        curve, best, gained = lines(line, colour)
        assert (curve[0].tolist(), curve[1].tolist()) == ([0, 2, 4, 6], lived)
        assert best[1].tolist() == [10, 10]
        assert (gained[0].tolist(), gained[1].tolist()) == (
            ([4], [30]) if colour == dune else ([6], [50])
        )
    assert labels(line)[0] == "The line of organism 3, living on"
    several = axes_of(assays.generalists, [found] * 8)
    assert len(several) == 12, "the first six worlds are drawn"
    assert labels(several[1])[0] == "The line of organism 3, world 3, living on"


def test_islands_have_colours_of_their_own() -> None:
    """Those of neighbours can be told apart: red, green and blue run from 0 to 1."""
    for count in (6, 8):
        names = [f"island-{k}" for k in range(count)]
        colours = style.island_colours(names)
        assert list(colours) == names
        assert len({*colours.values()}) == count
        assert all(colour == to_hex(colour) for colour in colours.values())
        shades = [np.array(to_rgb(colour)) for colour in colours.values()]
        assert min(np.linalg.norm(a - b) for a, b in combinations(shades, 2)) > 0.25


def seen(lives: Lives) -> Any:
    return run_of(lives, **SHORE, seeds=lives.worlds)


def test_curves_of_islands_are_those_of_their_own_organisms() -> None:
    lives = worlds_of(LIVED, [(1, 40, True), (3, 50, False)], until=90)
    moments, shore = np.array([1, 3, 10, 33, 60, 90]), Islands(NAMES, (0, 2, 8))
    living = islands.by_island(series.population, lives, shore, moments)
    for world, own in enumerate(lives.by_world()):
        for at, tick in enumerate(moments.tolist()):
            there = [int(own.cell[row] >= 2) for row in range(len(own)) if alive(own, row, tick)]
            assert living[:, world, at].tolist() == [there.count(0), there.count(1)]
    ages = islands.by_island(series.mean_age, lives, shore, moments)
    assert np.isnan(ages[1, 1]).all(), "both organisms are on the first island"


def test_a_child_of_a_parent_elsewhere_is_counted_where_it_is_born() -> None:
    """Organism 0 lives on the first island; it has three children there, and four elsewhere."""
    world = world_of([(0, 90, False)] + [(1, 80, False)] * 7)
    parent = np.array([-1, *[0] * 7])
    cell = np.array([0, 1, 1, 1, 2, 3, 4, 5], np.int32)
    lives = replace(world, parent=parent, cell=cell)
    shore = Islands(NAMES, (0, 2, 8))
    _, shares = islands.arrived_shares(lives, shore)
    known = np.isfinite(shares)
    assert known.sum(axis=1).tolist() == [1, 1]
    assert shares[known].tolist() == [0, 1]


@pytest.mark.parametrize("worlds", [1, 2])
def test_the_figure_of_islands_has_a_line_for_each(worlds: int) -> None:
    lives = worlds_of(*[LIVED] * worlds, until=90)
    living, ages, arrivals = axes_of(islands.draw, seen(lives), 0)
    colours = style.island_colours(NAMES)
    for axes in (living, ages, arrivals):
        assert all(len(lines(axes, colour)) == 1 for colour in colours.values())
    (x, y), (_, rest) = (lines(living, colour)[0] for colour in colours.values())
    assert (x[0], x[-1]) == (1, 90)
    assert (y[-1], rest[-1]) == (0.5, pytest.approx(2 / 6))
    assert key(living) == colours
    assert islands.draw(run_of(lives, cells=8, seeds=worlds), 0) is None


def test_space_time_has_borders_and_names_of_islands() -> None:
    run = seen(world_of(LIVED))
    axes, *_ = axes_of(spacetime.draw, run, 0)
    plain, *_ = axes_of(spacetime.draw, run_of(run.lives, cells=8), 0)
    borders = [x.tolist() for x, _ in lines(axes, style.INK) if len(x) == 2 and x[0] == x[1]]
    assert borders == [[1.5, 1.5]]
    words = [text for text in axes.texts if isinstance(text, Annotation)]
    named = {text.get_text(): text.xy for text in words if text.get_text() in NAMES}
    assert named == {"dune": (0.5, 1), "marsh": (4.5, 1)}
    assert not lines(plain, "#ffffff")
    assert not [text for text in plain.texts if text.get_text() in NAMES]
