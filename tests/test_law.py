"""The law, as whole worlds of habitats simple enough to know what must happen."""

from collections import Counter
from typing import Any

import numpy as np
import pytest

from primordia.gaussian import quantiles
from primordia.keys import Purpose, stream
from primordia.law.brain import join
from primordia.law.mutation import noise_index
from primordia.wide import happened, to_host, wide
from tests.chance import binomial, even
from tests.history import History
from tests.worlds import CLOCKWORK, MEADOW, MILL, Lived, config

SMALL = {"brain": {"kind": "feed-forward", "hidden": 1}}


def meadow(**habitat: Any) -> dict[str, Any]:
    return {"name": "tests.toys:Meadow", **habitat}


def placed(topology: str, rule: str, **values: Any) -> dict[str, Any]:
    placement = {"topology": topology, "rule": rule}
    return {"cells": 12, "seeds": 3, "replication": 0.2, "placement": placement, **values}


ENERGY = {"store": 50.0, "drain": 1.25, "gain": 1.7, "effort_cost": 0.5}
HISTORIES: dict[str, dict[str, Any]] = {
    "ring": placed("ring", "blind", hazard=0.09),
    "torus8": placed(
        "torus8",
        "empty-only",
        hazard=0.05,
        metabolism=ENERGY,
        habitat=meadow(food=0.3, effort=0.7),
        mutation={"probability": 1.0},
    ),
    "well-mixed": placed(
        "well-mixed",
        "replacing",
        hazard=0.15,
        metabolism={"store": 10.0, "gain": 3.0, "cap": 25.5},
        habitat=meadow(food=1.0),
    ),
    "control": placed(
        "torus4",
        "replacing",
        hazard=0.02,
        metabolism={"store": 20.0},
        habitat=meadow(lifespan=20),
        inheritance="founder",
        mutation={"founder_scale": 0.5},
    ),
    "fill": placed("well-mixed", "blind", hazard=0.2, genesis="fill"),
    "short": placed(
        "ring",
        "empty-only",
        metabolism={"store": 9.0},
        habitat=meadow(lifespan=9, broken_at=9),
        mutation={"probability": 0.0},
    ),
}
TICKS = 400


@pytest.fixture(scope="module")
def histories() -> dict[str, list[History]]:
    """All worlds, each held against the rules while its history is made."""
    configs = {name: config(MEADOW, **values) for name, values in HISTORIES.items()}
    configs["mill"] = config(MILL, seeds=2)
    made = {name: Lived(each, TICKS) for name, each in configs.items()}
    return {
        name: [History(run, world) for world in range(run.config.seeds)]
        for name, run in made.items()
    }


@pytest.mark.parametrize("name", [*HISTORIES, "mill"])
def test_records_keep_the_rules_of_the_world(
    histories: dict[str, list[History]], name: str
) -> None:
    for history in histories[name]:
        assert history.now == TICKS
        assert len(history.lives) > 20


def test_extinction_brings_founders_in_the_same_tick(histories: dict[str, list[History]]) -> None:
    for name in ("ring", "fill"):
        assert sum(len(history.extinctions) for history in histories[name]) > 3
    for history in histories["fill"]:
        founders = [life for life in history.lives if life.parent is None]
        assert len(founders) == 12 * (1 + len(history.extinctions))


def test_fixation_is_as_the_pedigree_says(histories: dict[str, list[History]]) -> None:
    fixed = 0
    for history in (each for all_ in histories.values() for each in all_):
        worlds = history.lived.engine.state.world.worlds
        then = history.fixation()
        assert bool(happened(worlds.fixed)[history.world]) == (then is not None)
        if then is not None:
            fixed += 1
            assert to_host(worlds.fixed)[history.world] == then[0]
            assert to_host(worlds.fixed_births)[history.world] == then[1]
    assert fixed > 10


@pytest.mark.parametrize("name", ["ring", "torus8", "well-mixed", "control", "fill"])
def test_hazard_strikes_its_share_of_organism_ticks(
    histories: dict[str, list[History]], name: str
) -> None:
    """Who dies of something graver may have been struck in the same tick; nobody can tell."""
    worlds = histories[name]
    died = Counter(life.cause for history in worlds for life in history.dead)
    at_risk = sum(history.organism_ticks for history in worlds) - died["starved"] - died["fatal"]
    assert binomial(died["hazard"], at_risk, HISTORIES[name]["hazard"])
    assert (died["replaced"] > 100) == (HISTORIES[name]["placement"]["rule"] == "replacing")


def test_mutants_and_copies_are_told_apart(histories: dict[str, list[History]]) -> None:
    def origins(name: str) -> list[str]:
        return [life.origin for each in histories[name] for life in each.lives if life.parent]

    assert set(origins("torus8")) == {"mutant"}
    assert set(origins("short")) == {"copy"}
    assert set(origins("control")) == {"founder"}
    half = origins("well-mixed")
    assert binomial(half.count("mutant"), len(half), 0.5)
    assert half.count("copy") + half.count("mutant") == len(half)


def test_of_several_causes_in_one_tick_the_gravest_counts(
    histories: dict[str, list[History]],
) -> None:
    """A life that ends in its tick for two reasons, and one that ends for three."""
    for history in histories["control"]:
        at_the_end = [life.cause for life in history.dead if life.age == 20]
        assert len(at_the_end) > 5
        assert set(at_the_end) == {"fatal"}
        assert max(life.age for life in history.dead) == 20
    for history in histories["short"]:
        assert {(life.cause, life.age) for life in history.dead} == {("fault", 9)}
        assert all(history.now - life.born < 9 for life in history.lives if life.died is None)


def genomes(run: Lived) -> np.ndarray:
    """Of the living, (n, P)."""
    organisms = run.engine.state.world.organisms
    blocks = {name: np.asarray(block) for name, block in organisms.genome.items()}
    return join(run.engine.law.brain, blocks)[np.asarray(organisms.alive)]


def test_without_heredity_nobody_is_like_anybody(histories: dict[str, list[History]]) -> None:
    flat = genomes(histories["control"][0].lived)
    weights = flat.shape[1]
    assert len(flat) > 10
    assert flat.std() == pytest.approx(0.5, rel=5 / np.sqrt(2 * flat.size))
    alike = np.corrcoef(flat)[np.triu_indices(len(flat), 1)]
    assert abs(alike).max() < 5.5 / np.sqrt(weights)


def test_newborns_begin_anew() -> None:
    """Stopped in a tick of births; everybody has sensed as often as it has lived."""
    run = Lived(config(MEADOW, **HISTORIES["ring"]), 10_000, births=200)
    (organisms, worlds), bodies = run.engine.state
    alive = np.asarray(organisms.alive)
    now = np.repeat(to_host(worlds.tick), 12)
    age = (now - to_host(organisms.born))[alive]
    assert (age == 0).any()
    assert (age > 5).any()
    np.testing.assert_array_equal(np.asarray(bodies)[alive, 0], age)
    memory = np.asarray(organisms.memory)[alive]
    np.testing.assert_array_equal((memory == 0).all(axis=1), age == 0)


def test_without_food_a_store_lasts_its_ticks() -> None:
    """The first has 100 units; those born after tick 50 have half a unit more."""
    more = {"kind": "schedule", "setting": "metabolism.store", "at": 50, "value": 100.5}
    values = {"replication": 0.0, "metabolism": {"store": 100.0}, "seasons": [more]}
    run = Lived(config(MEADOW, **SMALL, **values), 350)
    deaths = run.table("deaths")
    assert deaths["tick"].tolist() == [100, 201, 302]
    assert set(deaths["cause"]) == {"starved"}
    assert deaths["energy"].tolist() == [0.0, -0.5, -0.5]
    assert run.table("births")["tick"].tolist() == [0, 100, 201, 302]


def test_energy_is_accounted_for_to_the_unit(histories: dict[str, list[History]]) -> None:
    """Steps of 1/1024, rounded each tick: -1280 - 358 + 522 = -1116 a tick of 51,200."""
    for history in histories["torus8"]:
        assert {life.cause for life in history.dead} == {"starved", "hazard"}
        assert len({life.age for life in history.dead}) > 20
        for life in history.dead:
            assert life.energy * 1024 == 51_200 - 1116 * life.age
            assert life.food * 1024 == 307 * life.age
            assert (life.cause == "starved") == (life.age == 46)
        organisms, worlds = history.lived.engine.state.world
        ages = TICKS - to_host(organisms.born).astype(int)
        alive = np.asarray(organisms.alive)
        np.testing.assert_array_equal(organisms.energy[alive], (51_200 - 1116 * ages)[alive])
        np.testing.assert_array_equal(organisms.eaten[alive], (307 * ages)[alive])
        assert to_host(worlds.food)[history.world] == 307 * history.organism_ticks


def test_nobody_holds_more_than_the_cap(histories: dict[str, list[History]]) -> None:
    dead = [life for history in histories["well-mixed"] for life in history.dead]
    ages = {life.age for life in dead}
    assert min(ages) == 1
    assert max(ages) > 10
    for life in dead:
        assert life.energy == min(10 + 2 * life.age, 25.5)
        assert life.food == life.age


@pytest.mark.parametrize("where", ["genome", "memory"])
def test_a_nan_kills_its_owner_and_touches_nobody_else(where: str) -> None:
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
    poisoned.on(60)
    expected, found = whole.table("deaths"), poisoned.table("deaths")
    assert 2 < len(expected["id"]) < 15, "choose a seed under which some die and some live"
    mine = found["cell"] == cell
    assert found["tick"][mine].tolist() == [11]
    assert found["cause"][mine].tolist() == ["fault"]
    for column, values in expected.items():
        others = expected["cell"] != cell
        np.testing.assert_array_equal(found[column][~mine], values[others], err_msg=column)
    np.testing.assert_array_equal(poisoned.rows["births"][0], whole.rows["births"][0])
    after, without = (run.engine.state.world.organisms for run in (poisoned, whole))
    alive = np.asarray(after.alive)
    assert not alive[cell]
    np.testing.assert_array_equal(np.delete(alive, cell), np.delete(without.alive, cell))
    np.testing.assert_array_equal(
        np.asarray(after.memory)[alive], np.asarray(without.memory)[alive]
    )


@pytest.mark.parametrize(("rule", "speed"), [("blind", 0.1), ("empty-only", 0.2)])
def test_a_front_moves_at_the_speed_of_its_rule(rule: str, speed: float) -> None:
    """One founder on a large ring: p/2 cells a tick on each side if blind, p if not."""
    cells, worlds, ticks = 512, 4, 900
    values = {"cells": cells, "seeds": worlds, "replication": 0.2, "placement": {"rule": rule}}
    births = Lived(config(MEADOW, **SMALL, **values), ticks).table("births")
    advance = np.zeros((worlds, 2, 2), int)  # worlds, halves of the time, sides
    for world in range(worlds):
        mine = births["world"] == world
        cell, tick = births["cell"][mine].astype(int), births["tick"][mine]
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


def test_chance_in_worlds_that_go_extinct_all_the_time() -> None:
    """Founders appear anywhere; death, and replication of those who live on, are independent."""
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
    """Also where its cell is taken in the same tick, before its own child is written."""
    values = {"genesis": "fill", "replication": 0.6, "mutation": {"probability": 0.0}, "cells": 64}
    rule = {"placement": {"topology": "well-mixed", "rule": "replacing"}}
    history = History(Lived(config(MEADOW, **SMALL, **values, **rule), 3))
    worlds = history.lived.engine.state.world.worlds
    key = stream(worlds.seed, Purpose.FOUNDER, wide(np.zeros(1, np.uint64)))
    length = sum(history.lived.engine.law.block_sizes)
    founders = quantiles()[np.asarray(noise_index(key, np.arange(64), length))] * np.float32(0.01)
    living = sorted(history.living_after[3], key=lambda life: life.cell)
    roots = []
    for life in living:
        while life.parent is not None:
            life = life.parent
        roots.append(life.cell)
    assert 5 < len(set(roots)) < 50
    np.testing.assert_array_equal(genomes(history.lived), founders[roots])
    both = [life for life in history.lives if life.parent and life.parent.died == life.born]
    assert len(both) > 5, "nobody was replaced while it replicated"


def test_genesis_can_fill_every_cell() -> None:
    run = Lived(config(CLOCKWORK), 100)
    births = run.table("births")
    for world in range(2):
        history = History(run, world)
        assert history.extinctions == [31, 62, 93]
        mine = births["world"] == world
        assert births["tick"][mine].tolist() == np.repeat([0, 31, 62, 93], 16).tolist()
        assert births["cell"][mine].tolist() == [*range(16)] * 4
        assert births["id"][mine].tolist() == [*range(64)]
        assert {(life.cause, life.age) for life in history.dead} == {("starved", 31)}
    assert len(np.unique(genomes(run), axis=0)) == 32


CALM = {"cells": 12, "seeds": 4, "replication": 0.05, "hazard": 0.002, "saturation_ticks": 40}


@pytest.fixture(scope="module")
def calm() -> list[History]:
    run = Lived(config(MEADOW, **SMALL, **CALM), 3000)
    return [History(run, world) for world in range(4)]


def test_saturation_is_noted_when_a_full_world_was_calm_for_long_enough(
    calm: list[History],
) -> None:
    worlds = calm[0].lived.engine.state.world.worlds
    expected = [history.saturation() for history in calm]
    assert None not in expected
    assert len(set(expected)) > 1
    assert any(len(history.dead) for history in calm)
    assert any(history.calm_but_not_full() for history in calm)
    assert to_host(worlds.saturated).tolist() == [tick for tick, _ in expected]
    assert to_host(worlds.saturated_births).tolist() == [births for _, births in expected]


def prefix(table: dict[str, np.ndarray], world: int, last: int) -> dict[str, list]:
    mine = (table["world"] == world) & (table["tick"] <= last)
    return {column: values[mine].tolist() for column, values in table.items()}


@pytest.mark.parametrize("stop", [{"until": "saturation"}, {"births": 20}])
def test_each_world_stops_in_its_own_tick(calm: list[History], stop: dict[str, Any]) -> None:
    run = Lived(config(MEADOW, **SMALL, **CALM), 3000, **stop)
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
    run = Lived(config(MEADOW, **SMALL, **CALM), 123)
    assert to_host(run.engine.state.world.worlds.tick).tolist() == [123] * 4
    run.on(124)
    assert to_host(run.engine.state.world.worlds.tick).tolist() == [124] * 4


def test_the_gaussian_motor_adds_noise_to_every_action_and_infinite_food_is_a_fault() -> None:
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
        run.on(tick)
        eaten.append(np.asarray(run.engine.state.world.organisms.eaten) / 1024)
    each = np.diff(eaten, axis=0)
    assert abs(each.mean()) < 5 * 0.5 / np.sqrt(each.size)
    assert each.std() == pytest.approx(0.5, rel=5 / np.sqrt(2 * each.size))
    for what, other in {"tick": np.roll(each, 1, 0), "cell": np.roll(each, 1, 1)}.items():
        assert abs((each * other).mean()) < 5 * 0.25 / np.sqrt(each.size), what
    assert abs((each[:, :64] * each[:, 64:]).mean()) < 5 * 0.25 / np.sqrt(each.size / 2)
    run.on(41)
    deaths = run.table("deaths")
    assert deaths["tick"].tolist() == [40] * 128
    assert set(deaths["cause"]) == {"fault"}
