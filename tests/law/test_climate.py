"""The climate of invented worlds: how ratchets and schedules change it, and which settings it has."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.law.law import Law
from primordia.law.metabolism import ONE, Rates
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


@pytest.mark.parametrize(
    ("when", "quantities"),
    [
        ("saturation", [4 / 8, 5 / 8, 6 / 8]),
        ("mean_age", [10.0] * 3),
        ("food", [0.25, 1 / 6, -1 / 200]),
    ],
)
def test_a_ratchet_turns_above_its_threshold_and_not_at_it(
    when: str, quantities: list[float]
) -> None:
    first = quantities[0]
    for above in (first, first - 1 / 1024):
        law = meadow_law(ratchet(when, above))
        worlds, changed = applied(law, posed(law, [[0]] * W))
        assert changed == [quantity > above for quantity in quantities]
        expected = [0.025 if turned else 0.05 for turned in changed]
        np.testing.assert_array_equal(worlds.climate["replication"], np.float32(expected))
        assert worlds.looks.wait.tolist() == [[20]] * W


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
    for at in (TICK - 1, TICK, TICK + 1):
        season = {"kind": "schedule", "setting": "hazard", "at": at, "value": 0.25}
        law = meadow_law(season)
        worlds, changed = applied(law, posed(law, [[]] * W))
        assert changed == [at == TICK] * W
        assert worlds.climate["hazard"].tolist() == [0.25 if at == TICK else 0.0] * W


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


def test_cells_have_the_settings_of_their_world() -> None:
    law = meadow_law()
    climate = {"hazard": jnp.array([0.1, 0.2, 0.3]), "replication": jnp.array([1.0, 2.0, 3.0])}
    everywhere = law.in_cells(climate)
    some = law.in_cells(climate, jnp.array([0, 7, 8, 23, 15]))
    for name, values in climate.items():
        np.testing.assert_array_equal(everywhere[name], np.repeat(np.asarray(values), N))
        np.testing.assert_array_equal(some[name], np.asarray(values)[[0, 0, 1, 2, 1]])
    assert law.cell_numbers.tolist() == [*range(N)] * W
    assert law.per_cell(jnp.arange(W)).tolist() == [0] * N + [1] * N + [2] * N
    assert law.by_world(jnp.arange(2 * W * N).reshape(-1, 2)).shape == (W, N, 2)


def test_the_metabolism_takes_its_own_settings_from_the_climate() -> None:
    names = "store", "drain", "gain", "effort_cost", "cap"
    climate = {f"metabolism.{name}": name for name in reversed(names)} | {"gain": "other"}
    assert Rates.of(climate)._asdict() == {name: name for name in names} | {"price": None}
    assert Rates.of(climate | {"replication.price": 3}).price == 3
