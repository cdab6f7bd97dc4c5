"""The curves of a page are those of the records, counted one by one."""

from pathlib import Path

import numpy as np

from primordia.report import curves
from primordia.runs.archive import Archive


def test_middle_and_spread_end_where_fewer_than_half_of_the_worlds_have_a_value() -> None:
    """At the four places 4, 3, 2 and 1 of the 4 worlds have a value; two are enough."""
    nan = np.nan
    values = np.array([[1, 1, 1, 1], [3, 3, 5, nan], [5, 8, nan, nan], [7, nan, nan, nan]], float)
    table = curves.over_worlds("some", np.arange(1, 5), values, "#000000", each=False)
    kinds = {each["kind"]: each["values"] for each in table["curves"]}
    assert kinds["line"] == [4, 3, 3, None]
    assert kinds["low"] == [2.5, 2, 2, None]
    assert kinds["high"] == [5.5, 5.5, 4, None]


def test_no_number_is_lost_between_points_of_one_place() -> None:
    table = curves.table(
        np.array([1, 1, 2]), curves.curve("a", np.array([5.0, 6, np.nan]), "#000000")
    )
    assert table["x"] == [1, 2]
    assert table["curves"][0]["values"] == [6, None]


def test_thinned_curves_keep_their_ends() -> None:
    x = np.arange(1, 100_000)
    places, values = curves.thinned(x, x.astype(float))
    assert len(places) <= curves.POINTS + 1
    assert (places[0], places[-1]) == (1, 99_999)
    assert (places == values).all()
    steps, alive = curves.thinned(
        np.array([1, 99_000, 99_010, 100_000]), np.array([1, 0.5, 0.4, 0.3])
    )
    assert steps.tolist() == [1, 99_010, 100_000], "the last point of each place is kept"
    assert alive.tolist() == [1, 0.4, 0.3]


def test_axes_of_time_age_and_rate_are_logarithmic(torus: Path) -> None:
    panels = {panel["title"]: panel for panel in curves.panels(Archive(torus))}.items()
    scales = {title: (each.get("log_x"), each.get("log_y")) for title, each in panels}
    assert scales["Mean age of the living"] == (True, True)
    assert scales["Age at death"] == (None, True)
    assert scales["Organisms alive"] == (True, None)
    assert scales["Births and deaths"] == (True, True)
    assert scales["Alive at each age"] == (True, None)
