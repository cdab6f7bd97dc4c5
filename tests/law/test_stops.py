"""Saturation of worlds, and the ticks in which they stop."""

from typing import Any

import numpy as np
import pytest

from primordia.random.wide import to_host
from tests.chronicle import History
from tests.worlds import RING, Lived, config


@pytest.fixture(scope="module")
def calm() -> list[History]:
    run = Lived(config(RING), 1500)
    return [History(run, world) for world in range(4)]


def test_a_full_world_that_was_calm_for_long_enough_is_saturated(calm: list[History]) -> None:
    worlds = calm[0].lived.engine.state.world.worlds
    saturations = [history.saturation() for history in calm]
    expected = [moment for moment in saturations if moment is not None]
    assert len(expected) == len(saturations)
    assert len(set(expected)) > 1
    assert any(len(history.dead) for history in calm)
    assert any(history.calm_but_not_full() for history in calm)
    assert to_host(worlds.saturated).tolist() == [tick for tick, _ in expected]
    assert to_host(worlds.saturated_births).tolist() == [births for _, births in expected]


def prefix(table: dict[str, np.ndarray], world: int, last: int) -> dict[str, list]:
    rows = (table["world"] == world) & (table["tick"] <= last)
    return {column: values[rows].tolist() for column, values in table.items()}


@pytest.mark.parametrize("stop", [{"until": "saturation"}, {"births": 20}])
def test_each_world_stops_in_the_tick_of_its_limit(
    calm: list[History], stop: dict[str, Any]
) -> None:
    run = Lived(config(RING), 1500, **stop)
    worlds = run.engine.state.world.worlds
    for world, history in enumerate(calm):
        last = history.lives[19].born if "births" in stop else history.saturation()[0]
        assert to_host(worlds.tick)[world] == last
        History(run, world)
        for name in ("births", "deaths"):
            free = prefix(history.lived.table(name), world, last)
            stopped = prefix(run.table(name), world, 1500)
            np.testing.assert_equal(stopped, free)
    assert len(set(to_host(worlds.tick).tolist())) > 1
