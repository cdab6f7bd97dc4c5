"""Moments: organisms remember what they sensed, children what their parents did, founders nothing."""

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats import Compound, Continuous, Discrete
from primordia.law.genesis import begin
from primordia.law.moments import change_in, remember
from primordia.law.world import BirthCause, Cause, Remembered, World
from primordia.random.wide import wide
from tests.law.turning import turned
from tests.toys import Mill
from tests.worlds import MEADOW, MILL, Lived, config, law_of

KEPT, EVERY = 4, 3
MUTATION = {"kind": "calibrated", "remembered": KEPT, "every": EVERY, "founder_scale": 0.5}
SETTINGS: dict[str, Any] = {
    **MILL,
    "brain": {"hidden": 3},
    "mutation": MUTATION,
    "replication": 0.3,
    "hazard": 0.1,
    "seasons": [],
}


def test_a_world_remembers_what_it_senses_at_its_ticks() -> None:
    lived, habitat = Lived(config(SETTINGS), 1), Mill()
    before: Any = None
    inherited = 0
    for tick in range(2, 60):
        lived.advance_to(tick)
        (organisms, _), bodies = lived.engine.state
        senses = np.asarray(habitat.sense(bodies))
        now = jax.tree.map(np.asarray, organisms.moments)
        alive, born = np.asarray(organisms.alive), np.asarray(organisms.born.lo) == tick
        place = tick // EVERY % KEPT
        due = tick % EVERY == 0
        if due:
            assert now.known[alive, place].all()
            np.testing.assert_array_equal(now.senses[alive, place], senses[alive])
            np.testing.assert_array_equal(
                now.memory[alive, place], np.asarray(organisms.memory)[alive]
            )
        if before is not None:
            places = [each for each in range(KEPT) if not (due and each == place)]
            older = alive & ~born
            for name in Remembered._fields:
                one, other = getattr(now, name), getattr(before, name)
                np.testing.assert_array_equal(one[older][:, places], other[older][:, places])
            inherited += assert_of_parents(lived, tick, before, now, places)
        before = now
    assert inherited > 20


def test_only_children_have_moments_of_those_before_them() -> None:
    """World 0 dies out and is founded again; in world 1 an organism has a child."""
    law = law_of(MEADOW, seeds=2, cells=3, brain={"kind": "linear"}, mutation=MUTATION)
    world = begin(law, np.array([5, 6], np.uint64))
    organisms = world.organisms
    assert organisms.moments is not None
    moments = organisms.moments._replace(known=jnp.ones((6, KEPT), bool))
    alive = np.array([[True] * 3, [True, False, False]])
    organisms = organisms._replace(alive=jnp.asarray(alive.ravel()), moments=moments)
    cause = np.where([[True], [False]], Cause.FATAL, np.full((2, 3), -1))
    after = turned(law, world._replace(organisms=organisms), alive & (cause < 0), cause)
    np.testing.assert_array_equal(after.births["cause"] == BirthCause.FOUNDER, [True, False])
    assert after.organisms.moments is not None
    known = np.asarray(after.organisms.moments.known)[after.newborn]
    np.testing.assert_array_equal(known, [[False] * KEPT, [True] * KEPT])


def assert_of_parents(lived: Lived, tick: int, before: Any, now: Any, places: list[int]) -> int:
    """Compare the newborn of a tick with their parents; return how many there are."""
    births, number = lived.table("births"), np.asarray(lived.engine.state.world.organisms.number.lo)
    newborn = np.flatnonzero(births["tick"] == tick)
    for row in newborn:
        cell = births["cell"][row]
        if births["cause"][row] == "founder":
            assert not now.known[cell][places].any()
            continue
        first = np.flatnonzero(births["id"] == births["parent"][row])[0]
        parent = births["cell"][first]
        if number[parent] != births["parent"][row]:  # replaced by now
            continue
        np.testing.assert_array_equal(now.known[cell][places], before.known[parent][places])
        np.testing.assert_array_equal(now.senses[cell][places], before.senses[parent][places])
    return len(newborn)


def test_a_moment_is_stored_only_in_worlds_that_ran_to_a_tick_of_moments() -> None:
    """A moment is due in worlds 0 and 3. World 1 is between two such ticks, and world 2 has stopped."""
    law = law_of(MEADOW, cells=2, seeds=4, mutation=MUTATION)
    organisms, worlds = begin(law, np.arange(4, dtype=np.uint64))
    alive = jnp.array([1, 1, 1, 1, 1, 1, 1, 0], bool)
    before = jax.tree.map(lambda leaf: jnp.full_like(leaf, -5), organisms.moments)
    assert before is not None
    before = before._replace(known=jnp.zeros_like(before.known).at[:, 0].set(True))
    organisms = organisms._replace(
        alive=alive, memory=jnp.full_like(organisms.memory, 7), moments=before
    )
    world = World(organisms, worlds._replace(tick=wide([6, 7, 6, 21])))
    senses = jnp.arange(8 * law.senses, dtype=jnp.float32).reshape(8, -1)
    live = jnp.array([True, True, False, True])
    after = remember(law, world, senses, live).organisms.moments
    assert after is not None
    places = {
        0: 2,
        1: 2,
        6: 3,
        7: 3,
    }  # by cell; ticks 0, 12 and 24 have place 0, and tick 3 has place 1
    for cell in range(8):
        for place in range(KEPT):
            stored = places.get(cell) == place
            known = bool(alive[cell]) if stored else place == 0
            assert bool(after.known[cell, place]) == known
            sensed = senses[cell].tolist() if stored else [-5.0] * law.senses
            assert after.senses[cell, place].tolist() == sensed
            assert set(after.memory[cell, place].tolist()) == {7.0 if stored else -5.0}


ORGAN = {**MILL, "habitat": {"name": "tests.toys:Organ"}}


@pytest.mark.parametrize("base", [MILL, MEADOW, ORGAN])
def test_a_change_is_measured_in_the_moments_that_are_known(base: dict[str, Any]) -> None:
    """Continuous: the root mean square of outputs' changes. Discrete: the share of other choices.

    The organ has a choice among three, and two numbers: the larger of both changes counts.
    """
    choice, numbers = {
        "meadow": (slice(0, 2), slice(0, 0)),
        "mill": (slice(0, 0), slice(0, 2)),
        "organ": (slice(0, 3), slice(3, 5)),
    }[base["habitat"]["name"].split(":")[1].lower()]
    law = law_of({**base, "mutation": MUTATION, "seasons": []})
    random = np.random.default_rng(1)
    known = random.random((5, KEPT)) < 0.6
    known[0], known[1], known[4] = True, False, True
    moments = Remembered(
        jnp.asarray(random.normal(size=(5, KEPT, law.senses)), jnp.float32),
        jnp.asarray(random.normal(size=(5, KEPT, law.memory)), jnp.float32),
        jnp.asarray(known),
    )
    length = law.heredity.layout.length
    parents = random.normal(size=(5, length)).astype(np.float32)
    children = (parents + 0.2 * random.normal(size=(5, length))).astype(np.float32)
    children[4] = np.nan
    measured = np.asarray(change_in(law, moments, jnp.asarray(parents))(jnp.asarray(children)))
    for row in range(5):
        outputs = [
            np.array([output(law, genome[row], moments, row, each) for each in range(KEPT)])
            for genome in (parents, children)
        ]
        of = known[row]
        if not of.any():
            assert measured[row] == np.inf
            continue
        changes = []
        if choice.stop:
            other = np.not_equal(*(each[:, choice].argmax(axis=1) for each in outputs))
            changes.append(other[of].mean())
        if numbers.stop:
            moved = outputs[0][:, numbers] - outputs[1][:, numbers]
            square = np.nan_to_num(np.minimum(moved**2, 1), nan=1)
            changes.append(square[of].mean() ** 0.5)
        assert measured[row] == pytest.approx(max(changes), rel=1e-3)


def output(law: Any, genome: np.ndarray, moments: Remembered, row: int, place: int) -> np.ndarray:
    blocks = law.heredity.layout.split(jnp.asarray(genome)[None])
    memory, senses = moments.memory[row, place], moments.senses[row, place]
    return np.asarray(law.brain(blocks, memory[None], senses[None])[1][0])


@pytest.mark.parametrize("memory", [1, 0])
def test_a_moment_has_changed_if_any_of_its_choices_has(memory: int) -> None:
    """The change is the larger of two numbers, here of two choices and two vectors.

    One is the share of moments with another choice. The other is the root mean square difference of
    the vectors' numbers, each at most 1. Both are measured in brains without memory too.
    """
    action = Compound((Discrete(2), Continuous(1), Discrete(2), Continuous(2)))
    before = np.array([1, 0, 0, 1, 0, 0, 0], np.float32)
    first, second = [0, 1, 0, 1, 0, 0, 0], [1, 0, 0, 0, 1, 0, 0]
    both, same = [0, 1, 0, 0, 1, 0, 0], before
    moved, far = [1, 0, 0.5, 1, 0, 0, -0.25], [1, 0, 9, 1, 0, 0, np.nan]
    rows = np.array([[first, second, both, same], [moved] * 4, [far] * 4, [first] * 4, [far] * 4])
    known = np.array([[1, 1, 1, 1], [1, 1, 1, 1], [1, 0, 1, 0], [0, 0, 0, 1], [0] * 4], bool)

    def brain(genome: Any, memory: Any, senses: Any) -> tuple[Any, Any]:
        """Return the senses as outputs of a child, and the outputs of before for a parent."""
        child = next(iter(genome.values())).reshape(len(senses), -1)[:, :1] > 0
        return memory, jnp.where(child, senses, jnp.asarray(before))

    law = replace(law_of(MEADOW), brain=brain, action=action)
    moments = Remembered(
        jnp.asarray(rows, jnp.float32), jnp.zeros((5, 4, memory)), jnp.asarray(known)
    )
    parents = jnp.zeros((5, law.heredity.layout.length))
    change = np.asarray(change_in(law, moments, parents)(parents + 1))
    expected = [3 / 4, np.sqrt((0.5**2 + 0.25**2) / 3), np.sqrt(2 / 3), 1.0, np.inf]
    np.testing.assert_allclose(change, expected, rtol=1e-5)
