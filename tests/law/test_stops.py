"""Saturation of worlds, and the ticks in which they stop."""

from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.genesis import begin
from primordia.law.population import quiet_ticks, settle
from primordia.law.tick import no_fates
from primordia.random.wide import to_host
from tests.chronicle import History
from tests.worlds import MEADOW, Lived, config

CALM = {
    "cells": 12,
    "seeds": 4,
    "brain": {"kind": "feed-forward", "hidden": 1},
    "replication": 0.05,
    "hazard": 0.002,
    "saturation_ticks": 40,
}


@pytest.fixture(scope="module")
def calm() -> list[History]:
    run = Lived(config(MEADOW, **CALM), 3000)
    return [History(run, world) for world in range(4)]


def test_a_full_world_that_was_calm_for_long_enough_is_saturated(
    calm: list[History],
) -> None:
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
    run = Lived(config(MEADOW, **CALM), 3000, **stop)
    worlds = run.engine.state.world.worlds
    for world, history in enumerate(calm):
        last = history.lives[19].born if "births" in stop else history.saturation()[0]
        assert to_host(worlds.tick)[world] == last
        History(run, world)
        for name in ("births", "deaths"):
            free = prefix(history.lived.table(name), world, last)
            stopped = prefix(run.table(name), world, 3000)
            np.testing.assert_equal(stopped, free)
    assert len(set(to_host(worlds.tick).tolist())) > 1


def test_a_limit_of_ticks_is_exact() -> None:
    run = Lived(config(MEADOW, **CALM), 123)
    assert to_host(run.engine.state.world.worlds.tick).tolist() == [123] * 4
    run.advance_to(124)
    assert to_host(run.engine.state.world.worlds.tick).tolist() == [124] * 4


@pytest.mark.parametrize("calm", [0, 100, 2**31 - 101, 2**31 - 100, 2**31 - 2, 2**31 - 1])
def test_the_count_of_calm_ticks_saturates(calm: int) -> None:
    """After 2^31 ticks without births and deaths the next settling is still ahead, not behind."""
    made = config(MEADOW, **CALM)
    law, running = made.build_law(made.build_habitat()), jnp.array([True, True, True, False])
    world = begin(law, made.world_seeds)
    worlds = world.worlds._replace(calm=jnp.full(4, calm, jnp.int32))
    world = world._replace(
        organisms=world.organisms._replace(alive=jnp.ones_like(world.organisms.alive)),
        worlds=worlds._replace(sample_wait=jnp.full(4, 1000, jnp.int32)),
    )
    after, _, _ = settle(law, world, log.empty(law), no_fates(law), jnp.int32(100), running)
    assert after.worlds.calm.tolist() == [min(calm + 100, 2**31 - 1)] * 3 + [calm]
    assert 0 < int(quiet_ticks(law, after, running)) <= 900
