"""The law in whole worlds, with habitats so simple that one can say what must happen."""

import numpy as np
import pytest

from primordia.mutations.noise import noise_index
from primordia.random.gaussian import quantiles
from primordia.random.keys import Purpose, stream
from primordia.random.wide import wide
from tests.chance import binomial, even
from tests.chronicle import History
from tests.worlds import CLOCKWORK, MEADOW, Lived, config

SMALL = {"brain": {"kind": "feed-forward", "hidden": 1}}


def test_without_food_an_organism_lives_as_long_as_its_store_lasts() -> None:
    """The first organism has 100 units; organisms born after tick 50 have half a unit more."""
    more = {"kind": "schedule", "setting": "metabolism.store", "at": 50, "value": 100.5}
    values = {"replication": 0.0, "metabolism": {"store": 100.0}, "seasons": [more]}
    run = Lived(config(MEADOW, **SMALL, **values), 350)
    deaths = run.table("deaths")
    assert deaths["tick"].tolist() == [100, 201, 302]
    assert set(deaths["cause"]) == {"starved"}
    assert deaths["energy"].tolist() == [0.0, -0.5, -0.5]
    assert run.table("births")["tick"].tolist() == [0, 100, 201, 302]


@pytest.mark.parametrize("where", ["genome", "memory"])
def test_a_nan_kills_its_owner_and_changes_no_other_organism(where: str) -> None:
    alone = config(MEADOW, seed=4, replication=0.0, genesis="fill", hazard=0.01)
    whole, poisoned, cell = Lived(alone, 60), Lived(alone, 10), 3
    world, bodies = poisoned.engine.state
    organisms = world.organisms
    assert organisms.alive[cell]
    if where == "genome":
        block = organisms.genome["recurrent"].at[cell, 1, 2].set(np.nan)
        organisms = organisms._replace(genome={**organisms.genome, "recurrent": block})
    else:
        organisms = organisms._replace(memory=organisms.memory.at[cell, 5].set(np.nan))
    poisoned.engine.state = type(poisoned.engine.state)(world._replace(organisms=organisms), bodies)
    poisoned.advance_to(60)
    expected, actual = whole.table("deaths"), poisoned.table("deaths")
    assert 2 < len(expected["id"]) < 15, "choose a seed under which some die and some live"
    own = actual["cell"] == cell
    assert actual["tick"][own].tolist() == [11]
    assert actual["cause"][own].tolist() == ["fault"]
    for column, values in expected.items():
        others = expected["cell"] != cell
        np.testing.assert_array_equal(actual[column][~own], values[others], err_msg=column)
    np.testing.assert_array_equal(poisoned.rows["births"][0], whole.rows["births"][0])
    after, without = (run.engine.state.world.organisms for run in (poisoned, whole))
    alive = np.asarray(after.alive)
    assert not alive[cell]
    np.testing.assert_array_equal(np.delete(alive, cell), np.delete(without.alive, cell))
    np.testing.assert_array_equal(
        np.asarray(after.memory)[alive], np.asarray(without.memory)[alive]
    )


@pytest.mark.parametrize(
    ("rule", "speed"), [("blind", 0.1), pytest.param("empty-only", 0.2, marks=pytest.mark.slow)]
)
def test_a_front_moves_at_the_speed_of_its_rule(rule: str, speed: float) -> None:
    """A founder on a large ring spreads p/2 cells a tick on each side if placement is blind, else p."""
    cells, worlds, ticks = 512, 4, 900
    values = {"cells": cells, "seeds": worlds, "replication": 0.2, "placement": {"rule": rule}}
    births = Lived(config(MEADOW, **SMALL, **values), ticks).table("births")
    advance = np.zeros((worlds, 2, 2), int)  # worlds, halves of the time, sides
    for world in range(worlds):
        in_world = births["world"] == world
        cell, tick = births["cell"][in_world].astype(int), births["tick"][in_world]
        ahead = (cell - cell[0] + cells // 2) % cells - cells // 2
        for half, end in enumerate((ticks // 2, ticks)):
            reached = ahead[tick <= end]
            advance[world, half] = reached.max(), -reached.min()
            assert len(reached) == reached.max() - reached.min() + 1, "a gap behind the front"
        advance[world, 1] -= advance[world, 0]
    for half in range(2):
        for side in range(2):
            moved = int(advance[:, half, side].sum())
            assert binomial(moved, worlds * ticks // 2, speed)


def test_births_and_deaths_are_as_frequent_as_their_chances() -> None:
    """Founders appear in any cell. Death and the replication of survivors are independent."""
    values = {"replication": 0.3, "hazard": 0.5}
    history = History(Lived(config(MEADOW, **SMALL, **values), 4000))
    assert binomial(len(history.dead), history.organism_ticks, 0.5)
    founders = [life for life in history.lives if life.parent is None]
    assert [life.born for life in founders] == [0, *history.extinctions]
    cells = np.array([life.cell for life in founders])
    assert even(np.bincount(cells, minlength=16))
    assert binomial(int((cells[1:] == cells[:-1]).sum()), len(cells) - 1, 1 / 16)
    alone = survived = replicated = 0
    living = history.living_after[0]
    for tick in range(1, history.now + 1):
        before, living = living, history.living_after.get(tick, living)
        if len(before) == 1:
            alone += 1
            survived += before[0] in living
            replicated += before[0] in living and len(living) == 2
    assert binomial(survived, alone, 0.5)
    assert binomial(replicated, survived, 0.3)


def test_a_replaced_parent_passes_on_its_own_genome() -> None:
    """This holds also if its cell is taken in the same tick, before its own child is written."""
    values = {"genesis": "fill", "replication": 0.6, "mutation": {"probability": 0.0}, "cells": 64}
    rule = {"placement": {"topology": "well-mixed", "rule": "replacing"}}
    history = History(Lived(config(MEADOW, **SMALL, **values, **rule), 3))
    worlds = history.lived.engine.state.world.worlds
    key = stream(worlds.seed, Purpose.FOUNDER, wide(np.zeros(1, np.uint64)))
    length = history.lived.engine.law.heredity.layout.length
    founders = quantiles()[np.asarray(noise_index(key, np.arange(64), length))] * np.float32(0.01)
    living = sorted(history.living_after[3], key=lambda life: life.cell)
    roots = []
    for life in living:
        while life.parent is not None:
            life = life.parent
        roots.append(life.cell)
    assert 5 < len(set(roots)) < 50
    np.testing.assert_array_equal(history.lived.genomes(), founders[roots])
    both = [life for life in history.lives if life.parent and life.parent.died == life.born]
    assert len(both) > 5, "no organism was replaced while it replicated"


def test_genesis_can_fill_every_cell() -> None:
    run = Lived(config(CLOCKWORK), 100)
    births = run.table("births")
    for world in range(2):
        history = History(run, world)
        assert history.extinctions == [31, 62, 93]
        in_world = births["world"] == world
        assert births["tick"][in_world].tolist() == np.repeat([0, 31, 62, 93], 16).tolist()
        assert births["cell"][in_world].tolist() == [*range(16)] * 4
        assert births["id"][in_world].tolist() == [*range(64)]
        assert {(life.cause, life.age) for life in history.dead} == {("starved", 31)}
    assert len(np.unique(run.genomes(), axis=0)) == 32


def test_the_gaussian_motor_adds_noise_and_infinite_food_is_a_fault() -> None:
    values = {
        "habitat": {"name": "tests.toys:Echo", "rotten_at": 40},
        "replication": 0.0,
        "genesis": "fill",
        "cells": 64,
        "seeds": 2,
        "motor": {"kind": "gaussian", "sd": 0.5},
        "mutation": {"founder_scale": 0.0},
    }
    run = Lived(config(MEADOW, **SMALL, **values), 1)
    eaten = []
    for tick in range(1, 32):
        run.advance_to(tick)
        eaten.append(np.asarray(run.engine.state.world.organisms.eaten) / 1024)
    each = np.diff(eaten, axis=0)
    assert abs(each.mean()) < 5 * 0.5 / np.sqrt(each.size)
    assert each.std() == pytest.approx(0.5, rel=5 / np.sqrt(2 * each.size))
    for what, other in {"tick": np.roll(each, 1, 0), "cell": np.roll(each, 1, 1)}.items():
        assert abs((each * other).mean()) < 5 * 0.25 / np.sqrt(each.size), what
    assert abs((each[:, :64] * each[:, 64:]).mean()) < 5 * 0.25 / np.sqrt(each.size / 2)
    run.advance_to(41)
    deaths = run.table("deaths")
    assert deaths["tick"].tolist() == [40] * 128
    assert set(deaths["cause"]) == {"fault"}
