"""Worlds of invented states, settled once: when they are settled, counts of ticks, and samples."""

from functools import cache
from typing import Any

import jax
import numpy as np
import pytest

from primordia.law import events as log
from primordia.law.law import Law
from primordia.law.metabolism import ONE
from primordia.law.moments import moment_due, until_due
from primordia.law.population import quiet_ticks, settle
from primordia.law.sample import note_samples
from primordia.law.tick import no_fates
from primordia.law.world import World
from primordia.mutations.contract import Moments
from primordia.random.wide import to_host, wide
from tests.worlds import MEADOW, begun, law_of

W, N = 3, 4
FAR = 2**31 - 1
NEVER = 2**64 - 1
SEASONS: list[dict[str, Any]] = [
    {"kind": "schedule", "setting": "hazard", "at": 1000, "value": 0.5},
    {"kind": "ratchet", "setting": "replication", "when": "food", "above": 0.5, "factor": 0.5,
     "every": 700},
    {"kind": "ratchet", "setting": "metabolism.gain", "when": "saturation", "above": 0.75,
     "factor": 0.5, "every": 900},
]  # fmt: skip


@cache
def meadow_law(moments: bool = False) -> Law:
    more = {"mutation": {"kind": "calibrated", "remembered": 4, "every": 16}} if moments else {}
    return law_of(
        MEADOW, cells=N, seeds=W, brain={"kind": "linear"}, saturation_ticks=40, sample_every=600,
        metabolism={"store": 10.0}, seasons=SEASONS, **more,
    )  # fmt: skip


def posed(law: Law, tick: int = 500, **worlds: Any) -> World:
    """Return full worlds at a tick, saturated at tick 7, with other values for some of their arrays."""
    world = begun(law, np.arange(W, dtype=np.uint64), tick=tick)
    known = {"calm": [100] * W, "saturated": wide([7] * W), "saturated_births": wide([3] * W)}
    arrays = {
        name: value if isinstance(value, tuple) else np.asarray(value, np.int32)
        for name, value in (known | worlds).items()
    }
    return filled(World(world.organisms, world.worlds._replace(**arrays)))


def filled(world: World, empty: Any = ()) -> World:
    """Return worlds in which all cells but some are occupied."""
    alive = ~np.isin(np.arange(W * N), empty)
    return world._replace(organisms=world.organisms._replace(alive=alive))


@cache
def settling(law: Law) -> Any:
    lists, none = log.empty(law), no_fates(law)
    return jax.jit(lambda world, ticks, running: settle(law, world, lists, none, ticks, running))


_note_samples = jax.jit(note_samples, static_argnums=0)


def settled(law: Law, world: World, ticks: int, running: list[bool]) -> tuple[World, list[dict]]:
    """Settle worlds after quiet ticks; return them, and the samples taken."""
    after, events, newborn = settling(law)(world, np.int32(ticks), np.array(running))
    assert not newborn.any()
    assert int(events.births.filled) == int(events.deaths.filled) == 0
    rows = np.asarray(events.samples.rows)[: int(events.samples.filled)]
    columns = log.sample_columns(law.rates).unpacked(rows)
    return after, [{name: column[i] for name, column in columns.items()} for i in range(len(rows))]


ALL = [True] * W


def due(law: Law, world: World, running: list[bool] = ALL) -> int:
    return int(_due(law, world, np.array(running)))


_due = jax.jit(quiet_ticks, static_argnums=0)


def test_the_next_settling_is_at_the_first_sample_look_or_schedule_that_is_due() -> None:
    """Samples fall due at 600, looks at 700 and 900, a schedule at 1000."""
    law = meadow_law()
    assert due(law, posed(law)) == 100
    assert due(law, posed(law, sample_wait=[900, 250, 800])) == 200
    late = posed(law, tick=650, sample_wait=[900] * W)
    assert due(law, late) == 50
    waits = late.worlds.looks._replace(wait=np.int32([[600, 700], [700, 480], [500, 490]]))
    assert due(law, late._replace(worlds=late.worlds._replace(looks=waits))) == 350
    nearer = late.worlds._replace(looks=waits, tick=wide([650, 650, 700]))
    assert due(law, late._replace(worlds=nearer)) == 300
    past = late.worlds._replace(looks=waits, tick=wide([1000, 1000, 1001]))
    assert due(law, late._replace(worlds=past)) == 480


def test_a_calm_world_is_settled_in_the_tick_in_which_it_saturates() -> None:
    law = meadow_law()
    for calm, ticks in ((0, 40), (39, 1), (40, 100), (2**31 - 1, 100)):
        assert due(law, posed(law, calm=[200, calm, 200])) == ticks


def test_stopped_worlds_settle_nothing_and_worlds_without_life_at_once() -> None:
    law = meadow_law()
    world = posed(law, sample_wait=[10, 20, 30])
    assert due(law, world) == 10
    assert due(law, world, [False, True, True]) == 20
    assert due(law, world, [False] * 3) == FAR
    empty = filled(world, range(N, 2 * N))
    assert due(law, empty) == 0
    assert due(law, empty, [True, False, True]) == 10


def test_moments_fall_due_at_multiples_in_worlds_that_run() -> None:
    law = meadow_law(moments=True)
    assert due(law, posed(law, tick=500)) == 12
    assert due(law, posed(law, tick=512)) == 16
    worlds = posed(law, tick=512).worlds._replace(tick=wide([512, 2**32 + 16, 513]))
    assert until_due(Moments(4, 16), worlds).tolist() == [16, 16, 15]
    assert moment_due(law, worlds, np.array(ALL)).tolist() == [True, True, False]
    assert moment_due(law, worlds, np.array([True, False, True])).tolist() == [True, False, False]
    assert not moment_due(meadow_law(), worlds, np.array(ALL)).any()


def test_quiet_ticks_are_counted_in_the_worlds_that_run() -> None:
    law = meadow_law()
    world = posed(law, tick=500, calm=[1, 2, 3], sample_wait=[90, 80, 70])
    world = filled(world, [5, 6, 7, 10, 11])
    (organisms, worlds), samples = settled(law, world, 30, [True, True, False])
    assert not samples
    assert to_host(worlds.tick).tolist() == [530, 530, 500]
    assert to_host(worlds.organism_ticks).tolist() == [4 * 30, 30, 0]
    assert worlds.calm.tolist() == [31, 32, 3]
    assert worlds.sample_wait.tolist() == [60, 50, 70]
    assert worlds.looks.wait.tolist() == [[170, 370], [170, 370], [200, 400]]
    np.testing.assert_array_equal(organisms.alive, world.organisms.alive)


def test_a_full_running_world_is_saturated_once_after_enough_calm_ticks() -> None:
    """The tick and the births of the first time stay on record."""
    law, ticks = meadow_law(), 5
    fresh = {"saturated": wide([NEVER] * W), "saturated_births": wide([NEVER] * W)}
    births = wide([11, 12, 13])
    just = posed(law, calm=[35, 34, 36], births=births, **fresh)
    _, worlds = settled(law, just, ticks, ALL)[0]
    assert to_host(worlds.saturated).tolist() == [505, NEVER, 505]
    assert to_host(worlds.saturated_births).tolist() == [11, NEVER, 13]
    long = filled(posed(law, calm=[90] * W, births=births, **fresh), 2 * N + 3)
    _, worlds = settled(law, long, ticks, [False, True, True])[0]
    assert to_host(worlds.saturated).tolist() == [NEVER, 505, NEVER]
    assert to_host(worlds.saturated_births).tolist() == [NEVER, 12, NEVER]
    _, worlds = settled(law, posed(law, births=births), ticks, ALL)[0]
    assert to_host(worlds.saturated).tolist() == [7] * W
    assert to_host(worlds.saturated_births).tolist() == [3] * W


@pytest.mark.parametrize("calm", [2**31 - 101, 2**31 - 100, 2**31 - 1])
def test_the_count_of_calm_ticks_saturates(calm: int) -> None:
    """After 2^31 ticks without births and deaths the next settling is still ahead, not behind."""
    law, running = meadow_law(), [True, True, False]
    never = wide([NEVER] * W)
    world = posed(law, tick=0, calm=[calm] * W, sample_wait=[1000] * W, saturated=never)
    after, _ = settled(law, world, 100, running)
    assert after.worlds.calm.tolist() == [min(calm + 100, 2**31 - 1)] * 2 + [calm]
    assert 0 < due(law, after, running) <= 900


def test_samples_are_taken_where_they_are_due_and_wait_again() -> None:
    law = meadow_law()
    world = posed(law, sample_wait=[9, 10, 10])
    (_, worlds), samples = settled(law, world, 10 - 1, [True, True, False])
    assert [row["world"] for row in samples] == [0]
    assert worlds.sample_wait.tolist() == [600, 1, 10]
    (_, worlds), samples = settled(law, posed(law, sample_wait=[7, 8, 7]), 7, [True, True, False])
    assert [(row["world"], row["tick"]) for row in samples] == [(0, 507)]
    assert worlds.sample_wait.tolist() == [600, 1, 7]
    _, samples = settled(law, posed(law, sample_wait=[7, 8, 7]), 7, ALL)
    assert [row["world"] for row in samples] == [0, 2]


def test_a_change_of_climate_is_sampled_between_the_periodic_samples() -> None:
    """A world that has stopped at the tick of the schedule changes nothing and is not sampled."""
    law = meadow_law()
    looks = posed(law).worlds.looks._replace(wait=np.full((W, 2), 99, np.int32))
    world = posed(law, tick=995, sample_wait=[50] * W, looks=looks)
    later = world.worlds._replace(tick=wide([995, 990, 1000]))
    (_, worlds), samples = settled(law, world._replace(worlds=later), 5, [True, True, False])
    assert [(row["world"], row["tick"]) for row in samples] == [(0, 1000)]
    assert samples[0]["hazard"] == np.float32(0.5).view(np.uint32)
    assert worlds.climate["hazard"].tolist() == [0.5, 0.0, 0.0]
    assert worlds.sample_wait.tolist() == [45, 45, 50]


def test_a_sample_has_each_count_of_its_own_world() -> None:
    """Empty cells add neither energy nor age; debts of energy and negative food are kept."""
    law = meadow_law()
    cells = W * N
    world = posed(
        law,
        tick=900,
        births=wide([10, 20, 2**33]),
        extinctions=wide([1, 2, 3]),
        organism_ticks=wide([2**40, 5, 6]),
        food=wide([7, -8, 9]),
        deaths=wide(np.arange(W * 7).reshape(W, 7) * 1000),
    )
    alive = np.array([1, 0, 1, 1, 0, 0, 0, 1, 0, 1, 1, 0], bool)
    energy = np.arange(cells) * 3 * ONE - 10 * ONE
    born = np.array([880, 0, 890, 899, 0, 0, 0, 900, 5, 100, 850, 1])
    organisms = world.organisms._replace(
        alive=alive, energy=energy.astype(np.int32), born=wide(born)
    )
    climate = world.worlds.climate | {"hazard": np.float32([0.1, 0.2, 0.3])}
    world = World(organisms, world.worlds._replace(climate=climate))
    list_ = log.empty(law).samples
    before = list_._replace(filled=np.int32(2))
    after = _note_samples(law, world, np.array([True, False, True]), before)
    assert int(after.filled) == 4
    rows = log.sample_columns(law.rates).unpacked(np.asarray(after.rows[2:4]))
    assert not np.asarray(after.rows[:2]).any()
    for row, w in enumerate((0, 2)):
        own = [c for c in range(w * N, w * N + N) if alive[c]]
        ages = [900 - int(born[c]) for c in own]
        expected = {
            "world": w, "population": len(own), "tick": 900, "births": (10, 20, 2**33)[w],
            "extinctions": w + 1, "organism_ticks": (2**40, 5, 6)[w], "age_total": sum(ages),
            "oldest_age": max(ages), "energy_total": int(energy[own].sum()), "food_total": (7, -8, 9)[w],
        }  # fmt: skip
        causes = "fatal", "starved", "hazard", "replaced", "fault", "time_limit", "restart"
        expected |= {f"deaths_{c}": (7 * w + i) * 1000 for i, c in enumerate(causes)}
        assert {name: int(rows[name][row]) for name in expected} == expected
        assert rows["hazard"][row] == np.float32((0.1, 0.2, 0.3)[w]).view(np.uint32)
        assert rows["metabolism.store"][row] == np.float32(10).view(np.uint32)
