"""The figure of investment: the mean endowment of children in each bin of births."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from primordia.figures import investment, style
from primordia.history.investment import ENOUGH
from primordia.law.metabolism import ONE
from tests.assays.lives import COPY, FOUNDER, lives
from tests.figures.reading import axes_of, lines


def run_of(children: int, act: object = "act") -> Any:
    """Return a run in which child n of a founder begins with n units, and the founder with 1,000."""
    world = lives((-1, FOUNDER, 500), *[(0, COPY, 5)] * children)
    given = np.array([1000, *range(1, children + 1)], np.int32) * ONE
    return SimpleNamespace(
        lives=world, config=SimpleNamespace(act=act), endowments_of=lambda lives: given
    )


def test_bins_of_births_show_the_mean_endowment_of_their_children() -> None:
    """Founders do not count. A bin has ENOUGH births."""
    (axes,) = axes_of(investment.draw, run_of(3 * ENOUGH - 1), 0)
    ((x, y),) = lines(axes, style.BLUE)
    assert x.tolist() == [ENOUGH / 2, 3 * ENOUGH / 2, 5 * ENOUGH / 2]
    numbers = np.arange(3 * ENOUGH).reshape(3, -1)
    assert y.tolist() == [numbers[0, 1:].mean(), numbers[1].mean(), numbers[2].mean()]
    assert axes.get_xlim() == (0, 3 * ENOUGH)


def test_there_is_no_figure_without_an_act_or_without_children() -> None:
    assert investment.draw(run_of(50, act=None), 0) is None
    assert investment.draw(run_of(0), 0) is None
