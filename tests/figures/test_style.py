"""Axes in powers of ten, and curves of several worlds."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from primordia.figures import style
from tests.figures.reading import edges_at, lines


@pytest.fixture
def axes() -> Axes:
    return Figure().subplots()


@pytest.mark.parametrize(
    ("values", "limits"),
    [
        ([1, 10], (1, 10)),
        ([10], (10, 100)),
        ([0.02, 0.9], (0.01, 1)),
        ([999, 1001], (100, 10_000)),
        ([np.nan], (1, 10)),
        ([0, 5], (1, 10)),
    ],
)
def test_whole_powers_of_ten_surround_the_data(
    values: list[float], limits: tuple[float, float], axes: Axes
) -> None:
    axes.plot(np.ones(len(values)), values)
    style.logarithmic(axes.yaxis)
    assert axes.get_ylim() == pytest.approx(limits)
    assert axes.get_yscale() == "log"
    assert axes.get_xscale() == "linear"


def test_powers_of_ten_are_written_in_short_form(axes: Axes) -> None:
    axes.plot([0.01, 3000], [1, 1])
    style.logarithmic(axes.xaxis)
    shown = {1e-2: "1/100", 0.1: "0.1", 1: "1", 10: "10", 100: "100", 1e3: "1k", 1e4: "10k"}
    places = [at for at in axes.xaxis.get_major_locator().tick_values(0.01, 1e4) if at in shown]
    written = axes.xaxis.get_major_formatter()
    assert {place: written(place, 0) for place in places} == shown
    assert len(axes.xaxis.get_minorticklocs()) == 0
    style.linear(axes.yaxis)
    assert axes.yaxis.get_major_formatter()(1500, 0) == "1.5k"


def test_a_key_wider_than_its_panel_has_several_lines() -> None:
    """Otherwise the panels would be crushed. Words stay in order, and the title is above them."""
    words = {f"word {number}": style.BLUE for number in range(12)}
    with style.applied():
        figure = Figure(figsize=(style.PAGE, 2.4))
        panels = figure.subplots(1, 3)
        for axes in panels:
            style.title(axes, "Title", words)
        figure.draw_without_rendering()
    for axes in panels:
        boxes = [each.get_window_extent() for each in axes.texts]
        heights = [round(box.y0) for box in boxes]
        assert len(set(heights)) > 1
        assert heights == sorted(heights, reverse=True)
        assert max(box.x1 for box in boxes) < axes.get_window_extent().x1 + 50
        assert axes.get_window_extent().width > 0.2 * figure.bbox.width
        assert axes.title.get_window_extent().y0 > max(heights)


def test_median_and_quartiles_end_where_fewer_than_half_of_the_worlds_have_values(
    axes: Axes,
) -> None:
    """Two of four worlds are enough."""
    none = np.nan
    ys = np.array([
        [1, 2, 8, 9, none],
        [3, 3, 4, none, none],
        [9, 7, none, none, none],
        [5, 5, none, none, none],
    ])  # fmt: skip
    style.curves(axes, np.arange(5), ys, style.ORANGE)
    *worlds, (x, median) = lines(axes, style.ORANGE)
    np.testing.assert_array_equal([y for _, y in worlds], ys)
    np.testing.assert_array_equal(x, np.arange(5))
    np.testing.assert_array_equal(median, [4, 4, 6, none, none])
    (band,) = axes.collections
    assert to_hex(band.get_facecolor()[0]) == style.ORANGE
    for place, quartiles in ((0, (2.5, 6)), (1, (2.75, 5.5)), (2, (5, 7))):
        assert edges_at(band, place) == pytest.approx(quartiles)


def test_one_world_has_no_median_and_curves_of_many_worlds_are_fainter(axes: Axes) -> None:
    style.curves(axes, np.arange(3), np.array([[1.0, 2, 3]]))
    assert [y.tolist() for _, y in lines(axes)] == [[1, 2, 3]]
    assert len(axes.collections) == 0
    for count, alpha in ((2, 0.3), (20, 0.3), (60, 0.1)):
        axes.clear()
        style.curves(axes, np.arange(3), np.ones((count, 3)))
        *worlds, median = axes.get_lines()
        assert len(worlds) == count
        assert {each.get_alpha() for each in worlds} == {alpha}
        assert median.get_alpha() is None
        assert median.get_linewidth() > worlds[0].get_linewidth()
