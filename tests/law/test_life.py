"""One tick with invented outcomes: causes of death, food, energy, and which organisms replicate."""

from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import product
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats import Compound, Continuous, Discrete, Outcome
from primordia.habitats.contract import Action
from primordia.law import life, tick
from primordia.law.law import Law
from primordia.law.life import Thought, Vitals
from primordia.law.metabolism import ONE, Rates
from primordia.law.motor import Motor
from primordia.law.world import Cause, World
from primordia.mutations.noise import noise_index
from primordia.random.gaussian import quantiles
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide, to_host, wide
from tests.law.turning import drawn as of_cells
from tests.worlds import MEADOW, begun, law_of

RATES = Rates(*(np.float32(value) for value in (10, 1, 1, 1, 1e6)))


@cache
def meadow_law(hungry: bool = True) -> Law:
    """Return the law of two worlds of six cells, with a metabolism or without."""
    metabolism = {"metabolism": {"store": 10.0}} if hungry else {}
    return law_of(MEADOW, cells=6, seeds=2, hazard=0.5, replication=0.5, **metabolism)


JUDGE = jax.jit(life.judge, static_argnums=0)
JUDGE_WORLD = jax.jit(tick.judge, static_argnums=0)
KEYS = jax.jit(tick.keys_of)
NOISE = jax.jit(noise_index, static_argnums=2)
FAULTS = ("thought", "body", "food", "effort", "capacity", "reported")
REASONS = ("expired", "hungry", "fatal", *FAULTS)
CASES = np.array(list(product([False, True], repeat=len(REASONS))))


def judged(hungry: bool) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Judge a tick with every set of reasons to die; return energy, food and causes."""
    of = dict(zip(REASONS, CASES.T, strict=True))
    energy = np.where(of["hungry"], ONE, ONE + 1).astype(np.int32)
    outcome = Outcome(
        fatal=of["fatal"],
        food=np.where(of["food"], np.inf, 0.0).astype(np.float32),
        effort=np.where(of["effort"], np.nan, 0.0).astype(np.float32),
        expired=of["expired"],
        fault=of["reported"],
        capacity=np.where(of["capacity"], np.nan, 1.0).astype(np.float32),
    )
    bodies = np.where(of["body"], np.nan, 0.0).astype(np.float32)[:, None]
    vitals, cause = JUDGE(
        meadow_law(hungry), Vitals(energy, 0 * energy), of["thought"], bodies, outcome, RATES
    )
    return np.asarray(vitals.energy), np.asarray(vitals.eaten), np.asarray(cause)


@pytest.mark.parametrize("hungry", [True, False])
def test_of_all_reasons_to_die_the_gravest_is_the_cause(hungry: bool) -> None:
    """The drain of 1 leaves a hungry organism no energy, and any other organism one step."""
    _, _, cause = judged(hungry)
    expected = []
    for row in CASES:
        has = dict(zip(REASONS, row, strict=True))
        if any(has[why] for why in FAULTS):
            expected.append(Cause.FAULT)
        elif has["fatal"]:
            expected.append(Cause.FATAL)
        elif hungry and has["hungry"]:
            expected.append(Cause.STARVED)
        else:
            expected.append(Cause.TIME_LIMIT if has["expired"] else -1)
    assert cause.tolist() == expected
    of_bodies = Cause.TIME_LIMIT, Cause.STARVED, Cause.FATAL, Cause.FAULT
    assert of_bodies == life.BODILY, "a life that is lived alone can end by each of them"
    assert set(expected) == {-1, *of_bodies} - ({Cause.STARVED} if not hungry else set())


def test_food_is_counted_with_a_metabolism_and_without() -> None:
    """The food of a life is in the habitat's unit, without the gain. It may be negative."""
    vitals = Vitals(np.full(3, 5 * ONE, np.int32), np.array([0, 7, 2**30 - 65], np.int32))
    outcome = Outcome(np.zeros(3, bool), np.array([0.5, -0.25, 3.0], np.float32))
    rates = RATES._replace(gain=np.float32(2))
    for hungry, energies in ((True, [5.0, 3.5, 10.0]), (False, [5.0, 5.0, 5.0])):
        after, _ = JUDGE(meadow_law(hungry), vitals, np.zeros(3, bool), np.zeros(3), outcome, rates)
        assert after.eaten.tolist() == [ONE // 2, 7 - ONE // 4, 2**30 - 64]
        assert after.energy.tolist() == [energy * ONE for energy in energies]


def test_a_body_holds_no_more_energy_than_its_share_of_the_cap() -> None:
    vitals = Vitals(np.full(2, 5 * ONE, np.int32), np.zeros(2, np.int32))
    outcome = Outcome(np.zeros(2, bool), capacity=np.array([0.5, 1.0], np.float32))
    rates = RATES._replace(cap=np.float32(6))
    for hungry, energies in ((True, [3, 4]), (False, [5, 5])):
        after, _ = JUDGE(meadow_law(hungry), vitals, np.zeros(2, bool), np.zeros(2), outcome, rates)
        assert after.energy.tolist() == [energy * ONE for energy in energies]


NUMBERS = Continuous(3)


@dataclass(frozen=True)
class Free:
    """A brain that is a function, and for which thinking is free."""

    think: Any

    def __call__(self, *given: Any) -> Any:
        return self.think(*given)

    def spent(self, *given: Any) -> None:
        return None


def thought(motor: Motor, outputs: np.ndarray, action: Action = NUMBERS) -> Thought:
    """Return the thoughts of brains that give these outputs and remember their senses."""

    def brain(genome: Any, memory: Any, senses: Any) -> tuple[Any, Any]:
        return memory + senses, jnp.asarray(outputs)

    law = replace(meadow_law(), brain=Free(brain), motor=motor, action=action)
    memory, senses = np.ones((2, len(outputs), 3), np.float32)
    think = jax.jit(lambda *given: life.think(law, {}, *given))
    return think(memory, senses, key_of(len(outputs)), np.arange(len(outputs)))


def key_of(count: int) -> Wide:
    return stream(wide(np.arange(count)), Purpose.MOTOR, wide(np.full(count, 4)))


def test_an_output_that_is_not_finite_is_a_fault_wherever_it_is() -> None:
    outputs = np.zeros((7, 3), np.float32)
    for row, value in enumerate((np.nan, np.inf, -np.inf)):
        outputs[row, row], outputs[3 + row, :] = value, value
    found = thought(Motor(), outputs)
    assert found.faulty.tolist() == [True] * 6 + [False]
    assert (np.asarray(found.memory) == 2).all()
    np.testing.assert_array_equal(found.action, outputs)


def test_energy_spent_that_is_not_finite_is_a_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    spent = np.float32([np.nan, np.inf, -np.inf, 0.5])
    monkeypatch.setattr(Free, "spent", lambda *_: jnp.asarray(spent))
    found = thought(Motor(), np.zeros((4, 3), np.float32))
    assert found.faulty.tolist() == [True, True, True, False]


def test_the_gaussian_motor_adds_noise_of_its_scale_to_numbers_and_leaves_choices_alone() -> None:
    """A choice is the largest output, whatever the noise. Each number beside it has noise of its own."""
    outputs = np.random.default_rng(5).normal(size=(40, 6)).astype(np.float32)
    noise = quantiles()[np.asarray(NOISE(key_of(40), np.arange(40), 6))]
    action = Compound((Discrete(2), Continuous(2), Discrete(2)))
    found = np.asarray(thought(Motor(kind="gaussian", sd=100.0), outputs, action).action)
    np.testing.assert_array_equal(found[:, 0], outputs[:, :2].argmax(axis=1))
    np.testing.assert_allclose(found[:, 1:3], outputs[:, 2:4] + 100 * noise[:, 2:4], rtol=1e-5)
    np.testing.assert_array_equal(found[:, 3], outputs[:, 4:].argmax(axis=1))


def a_world(alive: np.ndarray, hazard: list[float], replication: list[float]) -> World:
    world = begun(meadow_law(), np.array([5, 2**40], np.uint64), tick=9)
    climate = world.worlds.climate | {
        "hazard": np.float32(hazard),
        "replication": np.float32(replication),
    }
    energy = np.full(12, 100 * ONE, np.int32)
    organisms = world.organisms._replace(alive=alive, energy=energy)
    return World(organisms, world.worlds._replace(climate=climate))


def fates(world: World, active: np.ndarray, **outcome: Any) -> tuple[World, tick.Fates]:
    """Judge the tick 12 of a world of tick 9."""
    keys = KEYS(world.worlds, np.int32(3))
    quiet = Thought(world.organisms.memory, np.zeros(12, np.int32), np.zeros(12, bool))
    of = Outcome(**{"fatal": np.zeros(12, bool), **outcome})
    return JUDGE_WORLD(meadow_law(), world, quiet, np.zeros(12), of, keys, active)


def test_the_motor_of_a_cell_draws_for_its_world_tick_and_place_in_the_world() -> None:
    def brain(genome: Any, memory: Any, senses: Any) -> tuple[Any, Any]:
        return memory - 1, 2 * senses

    motor = Motor(kind="gaussian", sd=0.5)
    law = replace(meadow_law(), brain=Free(brain), motor=motor, action=Continuous(2))
    world = a_world(np.ones(12, bool), [0, 0], [0, 0])
    senses = np.arange(24, dtype=np.float32).reshape(12, 2)
    think = jax.jit(partial(tick.think, law))
    found = think(world, senses, KEYS(world.worlds, np.int32(3)))
    key = stream(wide(np.repeat([5, 2**40], 6)), Purpose.MOTOR, wide(np.full(12, 12)))
    noise = quantiles()[np.asarray(NOISE(key, np.tile(np.arange(6), 2), 2))]
    np.testing.assert_allclose(found.action, 2 * senses + 0.5 * noise, rtol=1e-6)
    assert (np.asarray(found.memory) == -1).all()


def drawn(purpose: Purpose, chances: list[float]) -> np.ndarray:
    """Return in which cells an event of tick 12 happens, from the words of the cells."""
    words = np.asarray(of_cells([[5], [2**40]], purpose, 12, np.arange(6)).hi, float)
    return (words < np.array(chances)[:, None] * 2.0**32).ravel()


def test_accidents_and_births_are_drawn_for_each_cell_with_the_chances_of_its_world() -> None:
    """An accident kills an organism that has no other cause of death. Only active survivors replicate."""
    alive = np.array([1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 0, 1], bool)
    active = alive & (np.arange(12) != 5)
    hazard, replication = [0.25, 0.75], [0.75, 0.5]
    fatal = np.arange(12) % 5 == 1
    _, found = fates(a_world(alive, hazard, replication), active, fatal=fatal)
    struck = drawn(Purpose.HAZARD, hazard)
    expected = [
        -1 if not active[c] else Cause.FATAL if fatal[c] else Cause.HAZARD if struck[c] else -1
        for c in range(12)
    ]
    assert found.cause.tolist() == expected
    assert set(expected) == {-1, Cause.FATAL, Cause.HAZARD}
    wants = drawn(Purpose.REPLICATE, replication) & active & (np.array(expected) < 0)
    assert found.wants.tolist() == wants.tolist()
    assert 0 < wants.sum() < (np.array(expected) < 0).sum()


@pytest.mark.parametrize("dies", [False, True])
@pytest.mark.parametrize("empty", [[], [3], [3, 10]])
def test_a_tick_is_eventful_if_an_organism_dies_or_may_be_born(
    dies: bool, empty: list[int]
) -> None:
    """All organisms replicate if an empty cell is beside them, also if only the second world has one."""
    for cells in (empty, empty[1:]):
        alive = ~np.isin(np.arange(12), cells)
        fatal = np.zeros(12, bool)
        fatal[0] = dies
        _, found = fates(a_world(alive, [0, 0], [1, 1]), alive, fatal=fatal)
        assert bool(found.eventful) == (dies or bool(cells))
        assert int(found.wants.sum()) == alive.sum() - dies


def test_thinking_costs_energy_before_anyone_starves() -> None:
    """Of three organisms with 3 units, which drain by 1, one spends nothing, one 1.5 units and one 2."""
    vitals = Vitals(np.full(3, 3 * ONE, np.int32), np.zeros(3, np.int32))
    none, spent = np.zeros(3, bool), np.array([0, 1.5, 2], np.float32)
    after, cause = JUDGE(meadow_law(), vitals, none, np.zeros(3), Outcome(fatal=none), RATES, spent)
    assert after.energy.tolist() == [2 * ONE, ONE // 2, 0]
    assert cause.tolist() == [-1, -1, Cause.STARVED]


def test_food_of_a_world_is_that_of_its_active_organisms_rounded_one_by_one() -> None:
    """Negative food is subtracted. Infinite food, and food in cells that are not active, is left out."""
    active = np.array([1, 1, 1, 0, 1, 0, 1, 1, 0, 0, 0, 0], bool)
    food = np.array([0.1, 0.1, np.inf, 8, -3, np.nan, -0.5, -1, 9, 9, 9, 9], np.float32)
    world, _ = fates(a_world(np.ones(12, bool), [0, 0], [0, 0]), active, food=food)
    assert to_host(world.worlds.food).tolist() == [
        (102 + 102 - 3 * ONE) % 2**64,
        (-ONE // 2 - ONE) % 2**64,
    ]
