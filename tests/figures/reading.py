"""Figures of invented lives, and what their panels show: data, labels and keys, read from the axes."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from primordia.figures import foraging, style
from primordia.history.foraging import Foraging
from primordia.runs.lives import Lives
from tests.worlds import MEADOW, config


def run_of(lives: Lives, **settings: Any) -> Any:
    """Return what figures need of a run: its lives and its settings."""
    return SimpleNamespace(lives=lives, config=config(MEADOW, **settings))


def axes_of(draw: Callable[..., Figure | None], *given: Any) -> list[Axes]:
    """Return the panels of a figure, drawn in the style of the package."""
    with style.applied():
        figure = draw(*given)
    assert figure is not None
    return figure.axes


def food_panel(measured: Foraging, rate: float | None = None) -> Axes:
    """Return the panel of food for measured values; `rate`: ticks in a second, None without a clock."""
    run = SimpleNamespace(
        config=SimpleNamespace(metabolism=True), description=SimpleNamespace(rate=rate)
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(foraging, "foraging", lambda _: measured)
        (axes,) = axes_of(foraging.draw, run, 0)
    return axes


def lines(axes: Axes, colour: str | None = None) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the data of an axes' lines, all or those of one colour."""
    return [
        (np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float))
        for line in axes.get_lines()
        if colour is None or to_hex(line.get_color()) == colour
    ]


def points(axes: Axes, colour: str) -> list[tuple[float, float]]:
    """Return the points of all lines of a colour, in the order in which they are drawn."""
    return [
        pair for x, y in lines(axes, colour) for pair in zip(x.tolist(), y.tolist(), strict=True)
    ]


def edges_at(collection: Any, x: float) -> tuple[float, float]:
    """Return the lower and upper edge of a filled band at a place."""
    points = np.concatenate([path.vertices for path in collection.get_paths()])
    here = points[np.isclose(points[:, 0], x)][:, 1]
    return float(here.min()), float(here.max())


def key(axes: Axes) -> dict[str, str]:
    """Return the words of a panel's key and their colours."""
    words = [each for each in axes.texts if isinstance(each, Annotation)]
    places = {(0, 4 + style.LINE * line) for line in range(4)} | {(style.GAP, 0)}
    in_key = [each for each in words if each.get_position() in places]
    return {each.get_text(): to_hex(each.get_color()) for each in in_key}


def labels(axes: Axes) -> tuple[str, str, str]:
    """Return the title of a panel and the labels of its two axes."""
    return axes.get_title(loc="left"), axes.get_xlabel(), axes.get_ylabel()


def ticks(axis: Any) -> dict[float, str]:
    """Return the places of an axis that are labelled, with their labels."""
    names = [each.get_text() for each in axis.get_ticklabels()]
    return dict(zip(axis.get_ticklocs().tolist(), names, strict=True))
