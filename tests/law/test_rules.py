"""Worlds of many kinds, each checked against the rules when its history is made."""

from collections import Counter
from typing import Any

import numpy as np
import pytest

from primordia.random.wide import happened, to_host
from tests.chance import binomial
from tests.chronicle import History
from tests.worlds import MEADOW, MILL, Lived, config


def meadow(**habitat: Any) -> dict[str, Any]:
    return {"name": "tests.toys:Meadow", **habitat}


def placed(topology: str, rule: str, **values: Any) -> dict[str, Any]:
    placement = {"topology": topology, "rule": rule}
    return {"cells": 12, "seeds": 3, "replication": 0.2, "placement": placement, **values}


ENERGY = {"store": 50.0, "drain": 1.25, "gain": 1.7, "effort_cost": 0.5}
HISTORIES: dict[str, dict[str, Any]] = {
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
    "fill": placed("ring", "blind", hazard=0.2, genesis="fill"),
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
    """Make the histories of all worlds, which checks them against the rules."""
    configs = {name: config(MEADOW, **values) for name, values in HISTORIES.items()}
    configs["mill"] = config(MILL, seeds=2)
    made = {name: Lived(each, TICKS) for name, each in configs.items()}
    return {
        name: [History(run, world) for world in range(run.config.seeds)]
        for name, run in made.items()
    }


@pytest.mark.parametrize("name", [*HISTORIES, "mill"])
def test_records_obey_the_rules_of_their_world(
    histories: dict[str, list[History]], name: str
) -> None:
    for history in histories[name]:
        assert history.now == TICKS
        assert len(history.lives) > 20


def test_extinction_brings_founders_in_the_same_tick(histories: dict[str, list[History]]) -> None:
    assert sum(len(history.extinctions) for history in histories["fill"]) > 3
    for history in histories["fill"]:
        founders = [life for life in history.lives if life.parent is None]
        assert len(founders) == 12 * (1 + len(history.extinctions))


def test_fixation_is_that_of_the_pedigree(histories: dict[str, list[History]]) -> None:
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


@pytest.mark.parametrize("name", ["torus8", "well-mixed", "control", "fill"])
def test_hazard_strikes_its_share_of_organism_ticks(
    histories: dict[str, list[History]], name: str
) -> None:
    """An organism that dies of a graver cause may also be struck; records do not show that."""
    worlds = histories[name]
    died = Counter(life.cause for history in worlds for life in history.dead)
    at_risk = sum(history.organism_ticks for history in worlds) - died["starved"] - died["fatal"]
    assert binomial(died["hazard"], at_risk, HISTORIES[name]["hazard"])
    assert (died["replaced"] > 100) == (HISTORIES[name]["placement"]["rule"] == "replacing")


def test_mutants_and_copies_are_distinguished(histories: dict[str, list[History]]) -> None:
    def origins(name: str) -> list[str]:
        return [life.origin for each in histories[name] for life in each.lives if life.parent]

    assert set(origins("torus8")) == {"mutant"}
    assert set(origins("short")) == {"copy"}
    assert set(origins("control")) == {"founder"}
    half = origins("well-mixed")
    assert binomial(half.count("mutant"), len(half), 0.5)
    assert half.count("copy") + half.count("mutant") == len(half)


def test_of_several_causes_of_death_in_one_tick_the_gravest_is_recorded(
    histories: dict[str, list[History]],
) -> None:
    """One life ends for two reasons in the same tick, another for three."""
    for history in histories["control"]:
        at_the_end = [life.cause for life in history.dead if life.age == 20]
        assert len(at_the_end) > 5
        assert set(at_the_end) == {"fatal"}
        assert max(life.age for life in history.dead) == 20
    for history in histories["short"]:
        assert {(life.cause, life.age) for life in history.dead} == {("fault", 9)}
        assert all(history.now - life.born < 9 for life in history.lives if life.died is None)


def test_without_heredity_no_two_genomes_are_alike(histories: dict[str, list[History]]) -> None:
    flat = histories["control"][0].lived.genomes()
    weights = flat.shape[1]
    assert len(flat) > 10
    assert flat.std() == pytest.approx(0.5, rel=5 / np.sqrt(2 * flat.size))
    alike = np.corrcoef(flat)[np.triu_indices(len(flat), 1)]
    assert abs(alike).max() < 5.5 / np.sqrt(weights)


def test_newborns_begin_with_a_fresh_body_and_an_empty_memory() -> None:
    """The run stops in a tick of births; each organism has sensed as often as it has lived."""
    run = Lived(config(MEADOW, **HISTORIES["well-mixed"]), 10_000, births=200)
    (organisms, worlds), bodies = run.engine.state
    alive = np.asarray(organisms.alive)
    now = np.repeat(to_host(worlds.tick), 12)
    age = (now - to_host(organisms.born))[alive]
    assert (age == 0).any()
    assert (age > 5).any()
    np.testing.assert_array_equal(np.asarray(bodies)[alive, 0], age)
    memory = np.asarray(organisms.memory)[alive]
    np.testing.assert_array_equal((memory == 0).all(axis=1), age == 0)


def test_energy_is_accounted_for_to_the_unit(histories: dict[str, list[History]]) -> None:
    """Energy is in steps of 1/1024, rounded each tick: -1280 - 358 + 522 = -1116 a tick of 51,200."""
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


def test_no_organism_holds_more_than_the_cap(histories: dict[str, list[History]]) -> None:
    dead = [life for history in histories["well-mixed"] for life in history.dead]
    ages = {life.age for life in dead}
    assert min(ages) == 1
    assert max(ages) > 10
    for life in dead:
        assert life.energy == min(10 + 2 * life.age, 25.5)
        assert life.food == life.age
