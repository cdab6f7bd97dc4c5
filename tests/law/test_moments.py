"""Moments: organisms remember what they sensed, children what their parents did, founders nothing."""

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.habitats import Compound, Continuous, Discrete
from primordia.law.law import Law
from primordia.law.moments import change_in, remember
from primordia.law.world import Remembered, World
from primordia.random.wide import wide
from tests.worlds import MEADOW, MILL, begun, law_of

KEPT, EVERY = 4, 3
MUTATION = {"kind": "calibrated", "remembered": KEPT, "every": EVERY, "founder_scale": 0.5}


def test_a_moment_is_stored_only_in_worlds_that_ran_to_a_tick_of_moments() -> None:
    """A moment is due in worlds 0 and 3. World 1 is between two such ticks, and world 2 has stopped."""
    law = law_of(MEADOW, cells=2, seeds=4, mutation=MUTATION)
    organisms, worlds = begun(law, np.arange(4, dtype=np.uint64))
    alive = np.array([1, 1, 1, 1, 1, 1, 1, 0], bool)
    before = jax.tree.map(lambda leaf: np.full(leaf.shape, -5, leaf.dtype), organisms.moments)
    before = before._replace(known=np.arange(KEPT) < np.ones((8, 1)))
    memory = np.full(organisms.memory.shape, 7, np.float32)
    organisms = organisms._replace(alive=alive, memory=memory, moments=before)
    world = World(organisms, worlds._replace(tick=wide([6, 7, 6, 21])))
    senses = np.arange(8 * law.senses, dtype=np.float32).reshape(8, -1)
    live = np.array([True, True, False, True])
    after = jax.jit(remember, static_argnums=0)(law, world, senses, live).organisms.moments
    after = jax.tree.map(np.asarray, after)
    places = {
        0: 2,
        1: 2,
        6: 3,
        7: 3,
    }  # by cell; ticks 0, 12 and 24 have place 0, tick 3 has place 1
    for cell in range(8):
        for place in range(KEPT):
            stored = places.get(cell) == place
            known = bool(alive[cell]) if stored else place == 0
            assert bool(after.known[cell, place]) == known
            sensed = senses[cell].tolist() if stored else [-5.0] * law.senses
            assert after.senses[cell, place].tolist() == sensed
            assert set(after.memory[cell, place].tolist()) == {7.0 if stored else -5.0}


def changed(law: Law, moments: Remembered, parents: Any, children: Any) -> np.ndarray:
    """Return how far the behaviour of children differs from their parents', compiled."""
    measure = jax.jit(lambda known, of, new: change_in(law, known, of)(new))
    return np.asarray(measure(moments, parents, children))


def test_a_change_is_measured_in_the_moments_that_are_known() -> None:
    """Continuous: the root mean square of outputs' changes. Discrete: the share of other choices.

    The organ has a choice among three, and two numbers: the larger of both changes counts.
    """
    choice, numbers = slice(0, 3), slice(3, 5)
    law = law_of(MILL, habitat={"name": "tests.toys:Organ"}, mutation=MUTATION, seasons=[])
    random = np.random.default_rng(1)
    known = random.random((5, KEPT)) < 0.6
    known[0], known[1], known[4] = True, False, True
    senses, memory = (
        random.normal(size=(5, KEPT, size)).astype(np.float32) for size in (law.senses, law.memory)
    )
    moments = Remembered(senses, memory, known)
    length = law.heredity.layout.length
    parents = random.normal(size=(5, length)).astype(np.float32)
    children = (parents + 0.2 * random.normal(size=(5, length))).astype(np.float32)
    children[4] = np.nan
    measured = changed(law, moments, parents, children)
    think = jax.jit(law.brain.__call__)

    def output(genome: np.ndarray, place: int) -> np.ndarray:
        blocks = law.heredity.layout.split(genome)
        return np.asarray(think(blocks, memory[:, place], senses[:, place])[1])

    of_parents, of_children = (
        np.stack([output(genome, place) for place in range(KEPT)], axis=1)
        for genome in (parents, children)
    )
    for row in range(5):
        outputs = of_parents[row], of_children[row]
        of = known[row]
        if not of.any():
            assert measured[row] == np.inf
            continue
        other = np.not_equal(*(each[:, choice].argmax(axis=1) for each in outputs))
        moved = outputs[0][:, numbers] - outputs[1][:, numbers]
        square = np.nan_to_num(np.minimum(moved**2, 1), nan=1)
        expected = max(other[of].mean(), square[of].mean() ** 0.5)
        assert measured[row] == pytest.approx(expected, rel=1e-3)


def test_a_moment_has_changed_if_any_of_its_choices_has() -> None:
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
    moments = Remembered(np.float32(rows), np.zeros((5, 4, 0), np.float32), known)
    parents = np.zeros((5, law.heredity.layout.length), np.float32)
    change = changed(law, moments, parents, parents + 1)
    expected = [3 / 4, np.sqrt((0.5**2 + 0.25**2) / 3), np.sqrt(2 / 3), 1.0, np.inf]
    np.testing.assert_allclose(change, expected, rtol=1e-5)
