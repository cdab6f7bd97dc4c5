"""The settings of seasons at any tick of the past, from the metrics of invented runs."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.history.climate import PastClimate
from primordia.settings.islands import Islands

SAMPLES = [(0, 20, 3.0), (1, 10, 5.0), (0, 10, 2.0), (1, 15, 6.0), (0, 30, 4.0)]
"""World, tick and gain of each row of the metrics, in no order; world 2 has none."""
BEGINNING = {False: [1.0, 1.0, 1.0], True: [7.0, 8.0, 9.0]}
"""The gain with which each world begins: as configured, or in a fork as its source left it."""


@pytest.mark.parametrize("forked", [False, True])
def test_a_season_is_in_force_from_the_tick_after_the_one_at_whose_end_it_acts(
    forked: bool,
) -> None:
    """Births of tick 10 still have the settings before the season that acts at the end of tick 10."""
    world, tick, gain = zip(*SAMPLES, strict=True)
    stored = {"world.worlds.climate.metabolism.gain": np.float32(BEGINNING[True])}
    run: Any = SimpleNamespace(
        config=SimpleNamespace(seasons=["any"], seeds=3, islands=Islands(("",), (0, 9))),
        description=SimpleNamespace(beginning={"metabolism.gain": 1.0}),
        origin=stored if forked else None,
        metrics=pa.table({"world": world, "tick": tick, "metabolism.gain": np.float32(gain)}),
    )
    asked = [(which, when) for when in range(33, -1, -1) for which in (2, 0, 1)]
    expected = []
    for which, when in asked:
        now = BEGINNING[forked][which]
        for sampled_in, at, value in sorted(SAMPLES):
            if sampled_in == which and at < when:
                now = value
        expected.append(now)
    found = PastClimate(run).of_worlds(*np.array(asked).T)
    assert found["metabolism.gain"].tolist() == expected
    none = np.zeros(len(asked), int)
    lives: Any = SimpleNamespace(world=np.array(asked)[:, 0], born=none, cell=none)
    of_lives = PastClimate(run).of_lives(lives, np.array(asked)[:, 1])
    assert of_lives["metabolism.gain"].tolist() == expected
