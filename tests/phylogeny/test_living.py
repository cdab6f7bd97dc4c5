"""Turnover of a world: its births and deaths, one after another."""

import numpy as np

from primordia.phylogeny.living import Turnover
from tests.synthetic import world_of


def test_deaths_of_one_tick_are_in_the_order_of_births() -> None:
    """Organisms are born in ten ticks, and die in three."""
    lived = [(place // 30, 20 + place * 7 % 3 - place // 30, True) for place in range(300)]
    lives = world_of(lived, until=30)
    turnover = Turnover.of(lives)
    expected = sorted(range(300), key=lambda row: (lives.ended[row], row))
    np.testing.assert_array_equal(turnover.row[~turnover.birth], expected)
