"""The climate of invented worlds: how ratchets and schedules change it, and which settings it has."""

from functools import partial
from typing import Any

import jax
import numpy as np

from primordia.law.law import Law
from primordia.law.metabolism import ONE
from primordia.law.seasons import apply_seasons, ratchets
from primordia.law.world import World, Worlds
from primordia.random.wide import to_host, wide
from tests.worlds import MEADOW, begun, law_of

W, N, TICK = 3, 8, 40


def ratchet(when: str, above: float, setting: str = "replication") -> dict[str, Any]:
    return {
        "kind": "ratchet", "setting": setting, "when": when, "above": above, "factor": 0.5, "every": 20,
    }  # fmt: skip


def meadow_law(*seasons: dict[str, Any], **values: Any) -> Law:
    return law_of(MEADOW, cells=N, seeds=W, seasons=seasons, metabolism={"store": 10.0}, **values)


def posed(law: Law, wait: list[list[int]], **looks: Any) -> World:
    """Return worlds of 4, 5 and 6 organisms of age 10, with other values for their looks."""
    world = begun(law, np.arange(W, dtype=np.uint64), tick=TICK)
    alive = np.arange(N) < np.array([4, 5, 6])[:, None]
    organisms = world.organisms._replace(alive=alive.ravel(), born=wide(np.full(W * N, TICK - 10)))
    worlds = world.worlds._replace(
        food=wide([100 * ONE, 50 * ONE, -ONE]),
        organism_ticks=wide([400, 300, 200]),
        looks=world.worlds.looks._replace(wait=np.array(wait, np.int32).reshape(W, -1), **looks),
    )
    return World(organisms, worlds)


def applied(law: Law, world: World, running: tuple[bool, ...] = (True,) * W) -> tuple[Worlds, list]:
    apply = jax.jit(partial(apply_seasons, law.seasons, law.governed))
    worlds, changed = apply(world, np.array(running))
    return worlds, changed.tolist()


SETTINGS = {"saturation": "replication", "mean_age": "metabolism.gain", "food": "hazard"}
"""The setting of the ratchet that looks at each quantity."""


def test_a_ratchet_turns_above_its_threshold_and_not_at_it() -> None:
    """The first world is at all thresholds. Of two equal ratchets, those of saturation, both turn."""
    above = {"saturation": 4 / 8, "mean_age": 10.0, "food": 1 / 4}
    every = [ratchet(when, above[when], name) for when, name in SETTINGS.items()]
    law = meadow_law(every[0], *every, hazard=0.5)
    (organisms, worlds) = posed(law, [[0] * 4] * W)
    born = wide(np.repeat([TICK - 10, TICK - 9, TICK - 11], N))
    worlds = worlds._replace(food=wide([100 * ONE, -ONE, 51 * ONE]))
    worlds, changed = applied(law, World(organisms._replace(born=born), worlds))
    turned = {"saturation": [1, 0.25, 0.25], "mean_age": [1, 1, 0.5], "food": [1, 1, 0.5]}
    assert changed == [False, True, True]
    for when, name in SETTINGS.items():
        expected = np.float32(dict(law.beginning)[name]) * np.float32(turned[when])
        np.testing.assert_array_equal(worlds.climate[name], expected, name)
    assert worlds.looks.wait.tolist() == [[20] * 4] * W


def test_a_ratchet_that_is_due_looks_at_the_food_since_its_own_last_look() -> None:
    """A look that is not due, or is of a stopped world, keeps the food and ticks of the look before."""
    law = meadow_law(ratchet("food", 0.25), ratchet("food", 0.4, "metabolism.gain"))
    assert [each.setting for each in ratchets(law.seasons)] == ["replication", "metabolism.gain"]
    food, lived = [[90, 60], [10, 47], [-5, 1]], [[370, 350], [100, 290], [10, 20]]
    was = {"food": wide(np.array(food) * ONE), "organism_ticks": wide(lived)}
    world = posed(law, [[0, 0], [7, 0], [0, 0]], **was)
    worlds, changed = applied(law, world, (True, True, False))
    # (100 - 90) / (400 - 370) = 0.33 and (100 - 60) / (400 - 350) = 0.8; (50 - 47) / (300 - 290) = 0.3
    assert changed == [True, False, False]
    np.testing.assert_array_equal(worlds.climate["replication"], np.float32([0.025, 0.05, 0.05]))
    assert worlds.climate["metabolism.gain"].tolist() == [0.5, 1.0, 1.0]
    assert worlds.looks.wait.tolist() == [[20, 20], [7, 20], [0, 0]]
    seen = [[100, 100], [10, 50], [-5, 1]]
    expected = [[steps * ONE % 2**64 for steps in row] for row in seen]
    assert to_host(worlds.looks.food).tolist() == expected
    assert to_host(worlds.looks.organism_ticks).tolist() == [[400, 400], [100, 300], [10, 20]]


def test_schedules_are_due_in_their_own_tick_only() -> None:
    law = meadow_law({"kind": "schedule", "setting": "hazard", "at": TICK, "value": 0.25})
    world = posed(law, [[]] * W)
    ticks = world.worlds._replace(tick=wide([TICK - 1, TICK, TICK + 1]))
    worlds, changed = applied(law, world._replace(worlds=ticks))
    assert changed == [False, True, False]
    assert worlds.climate["hazard"].tolist() == [0.0, 0.25, 0.0]


def test_a_law_has_a_hazard_at_its_beginning_or_in_a_season() -> None:
    other = {"kind": "schedule", "setting": "replication", "at": 5, "value": 0.5}
    accidents = {**other, "setting": "hazard"}
    assert meadow_law(hazard=0.001).has_hazard
    assert not meadow_law(hazard=0.0).has_hazard
    assert not meadow_law(other).has_hazard
    assert meadow_law(other, accidents).has_hazard


def test_a_law_knows_which_settings_a_season_changes() -> None:
    law = meadow_law()
    assert law.governed("hazard") == ["hazard"]
    assert law.governed("metabolism.cap") == ["metabolism.cap"]
    assert law.governed("mutation.blocks.output.scale") == ["mutation.blocks.output.scale"]
    scales = law.governed("mutation.scale")
    assert scales == [f"mutation.blocks.{name}.scale" for name in law.heredity.layout.names]
    for unknown in ("cells", "metabolism.speed", "mutation.founder_scale", "mutation"):
        assert law.governed(unknown) == []
