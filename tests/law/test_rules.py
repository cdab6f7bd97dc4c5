"""Worlds of many kinds, each checked against the rules when its history is made."""

from collections import Counter
from functools import cache
from typing import Any

import jax
import numpy as np
import pytest
from jax import Array

from primordia.random.wide import happened, to_host
from tests.chance import binomial
from tests.chronicle import History
from tests.toys import Meadow
from tests.worlds import MEADOW, MILLS, Lived, config

KEPT, EVERY = 4, 3


class Clock(Meadow):
    """A meadow whose bodies perceive their age."""

    def sense(self, bodies: Array) -> Array:
        return bodies


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
        habitat={"name": f"{__name__}:Clock", "food": 0.3, "effort": 0.7, "lifespan": 46},
        mutation={"kind": "calibrated", "probability": 1.0, "remembered": KEPT, "every": EVERY},
        brain={"hidden": 3},
    ),
    "mills": {**MILLS, "replication": 0.12},
    "control": placed(
        "well-mixed",
        "replacing",
        hazard=0.02,
        metabolism={"store": 10.0, "gain": 3.0, "cap": 25.5},
        habitat={"name": "tests.toys:Meadow", "food": 1.0},
        inheritance="founder",
        mutation={"founder_scale": 0.5},
    ),
}
"""Worlds that differ in every rule. Each organism of the first starves in the tick in which it is old."""
TICKS = 400
TORUS, CONTROL = (pytest.param(name, marks=pytest.mark.slow) for name in ("torus8", "control"))
every_world = pytest.mark.parametrize("name", [TORUS, "mills", CONTROL])


@cache
def histories(name: str) -> list[History]:
    """Make the histories of worlds, which checks them against the rules."""
    run = Lived(config({**MEADOW, **HISTORIES[name]}), TICKS)
    return [History(run, world) for world in range(run.config.seeds)]


@every_world
def test_records_obey_the_rules_of_their_world(name: str) -> None:
    for history in histories(name):
        assert history.now == TICKS
        assert len(history.lives) > 20


@every_world
def test_fixation_is_that_of_the_pedigree(name: str) -> None:
    fixed = 0
    for history in histories(name):
        worlds = history.lived.engine.state.world.worlds
        then = history.fixation()
        assert bool(happened(worlds.fixed)[history.world]) == (then is not None)
        if then is not None:
            fixed += 1
            assert to_host(worlds.fixed)[history.world] == then[0]
            assert to_host(worlds.fixed_births)[history.world] == then[1]
    assert fixed == len(histories(name))


@every_world
def test_hazard_strikes_its_share_of_organism_ticks(name: str) -> None:
    """An organism that dies of a graver cause may also be struck; records do not show that."""
    worlds = histories(name)
    died = Counter(life.cause for history in worlds for life in history.dead)
    at_risk = sum(history.organism_ticks for history in worlds) - died["starved"] - died["fatal"]
    assert binomial(died["hazard"], at_risk, HISTORIES[name]["hazard"])
    assert (died["replaced"] > 100) == (HISTORIES[name]["placement"]["rule"] == "replacing")


@pytest.mark.parametrize(
    ("name", "origins"),
    [
        pytest.param("torus8", {"mutant"}, marks=pytest.mark.slow),
        ("mills", {"mutant", "copy"}),
        pytest.param("control", {"founder"}, marks=pytest.mark.slow),
    ],
)
def test_children_are_mutants_or_copies_or_without_heredity_founders(
    name: str, origins: set[str]
) -> None:
    lives = [life for each in histories(name) for life in each.lives]
    assert {life.origin for life in lives if life.parent} == origins


@pytest.mark.slow
def test_without_heredity_no_two_genomes_are_alike() -> None:
    flat = histories("control")[0].lived.genomes()
    weights = flat.shape[1]
    assert len(flat) > 10
    assert flat.std() == pytest.approx(0.5, rel=5 / np.sqrt(2 * flat.size))
    alike = np.corrcoef(flat)[np.triu_indices(len(flat), 1)]
    assert abs(alike).max() < 5.5 / np.sqrt(weights)


@pytest.mark.slow
def test_newborns_begin_with_a_fresh_body_and_an_empty_memory() -> None:
    """The run stops in a tick of births; each organism has sensed as often as it has lived."""
    run = Lived(config(MEADOW, **HISTORIES["torus8"]), 10_000, births=200)
    (organisms, worlds), bodies = run.engine.state
    alive = np.asarray(organisms.alive)
    now = np.repeat(to_host(worlds.tick), 12)
    age = (now - to_host(organisms.born))[alive]
    assert (age == 0).any()
    assert (age > 5).any()
    np.testing.assert_array_equal(np.asarray(bodies)[alive, 0], age)
    memory = np.asarray(organisms.memory)[alive]
    np.testing.assert_array_equal((memory == 0).all(axis=1), age == 0)


@pytest.mark.slow
def test_a_world_remembers_what_it_senses_at_its_ticks() -> None:
    """Children have the moments of their parents, and founders none."""
    lived = Lived(config(MEADOW, **HISTORIES["torus8"]), 1)
    before: Any = None
    inherited = 0
    for tick in range(2, 60):
        lived.advance_to(tick)
        (organisms, _), bodies = lived.engine.state
        now = jax.tree.map(np.asarray, organisms.moments)
        alive, born = np.asarray(organisms.alive), np.asarray(organisms.born.lo) == tick
        place = tick // EVERY % KEPT
        due = tick % EVERY == 0
        if due:
            assert now.known[alive, place].all()
            np.testing.assert_array_equal(now.senses[alive, place], np.asarray(bodies)[alive])
            memory = np.asarray(organisms.memory)[alive]
            np.testing.assert_array_equal(now.memory[alive, place], memory)
        if before is not None:
            places = [each for each in range(KEPT) if not (due and each == place)]
            older = alive & ~born
            for one, other in zip(now, before, strict=True):
                np.testing.assert_array_equal(one[older][:, places], other[older][:, places])
            inherited += assert_of_parents(lived, tick, before, now, places)
        before = now
    assert inherited > 20


def assert_of_parents(lived: Lived, tick: int, before: Any, now: Any, places: list[int]) -> int:
    """Compare the children of a tick with their parents; return how many there are."""
    births = lived.table("births")
    cells = births["cell"] + 12 * births["world"].astype(int)
    children = np.flatnonzero(births["tick"] == tick)
    for row in children:
        cell = cells[row]
        if births["cause"][row] == "founder":
            assert not any(each[cell][places].any() for each in now)
            continue
        own = (births["id"] == births["parent"][row]) & (births["world"] == births["world"][row])
        parent = cells[np.flatnonzero(own)[0]]
        for one, other in zip(now, before, strict=True):
            np.testing.assert_array_equal(one[cell][places], other[parent][places])
    return len(children)


@pytest.mark.slow
def test_energy_is_accounted_for_to_the_unit() -> None:
    """Energy is in steps of 1/1024, rounded each tick: -1280 - 358 + 522 = -1116 a tick of 51,200."""
    for history in histories("torus8"):
        assert {life.cause for life in history.dead} == {"fatal", "hazard"}
        assert len({life.age for life in history.dead}) > 20
        for life in history.dead:
            assert life.energy * 1024 == 51_200 - 1116 * life.age
            assert life.food * 1024 == 307 * life.age
            assert (life.cause == "fatal") == (life.age == 46), "a body's end is graver"
        organisms, worlds = history.lived.engine.state.world
        ages = TICKS - to_host(organisms.born).astype(int)
        alive = np.asarray(organisms.alive)
        np.testing.assert_array_equal(organisms.energy[alive], (51_200 - 1116 * ages)[alive])
        np.testing.assert_array_equal(organisms.eaten[alive], (307 * ages)[alive])
        assert to_host(worlds.food)[history.world] == 307 * history.organism_ticks


@pytest.mark.slow
def test_no_organism_holds_more_than_the_cap() -> None:
    dead = [life for history in histories("control") for life in history.dead]
    ages = {life.age for life in dead}
    assert min(ages) == 1
    assert max(ages) > 10
    for life in dead:
        assert life.energy == min(10 + 2 * life.age, 25.5)
        assert life.food == life.age
