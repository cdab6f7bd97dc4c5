"""Brains with an efference copy perceive the last tick's senses and command beside this tick's senses."""

from typing import Any

import jax
import numpy as np
from jax import Array

from primordia.brains.contract import Brain
from primordia.brains.plastic import Plastic
from primordia.habitats.contract import Compound, Continuous, Discrete
from primordia.law.efference import Efferent
from primordia.law.metabolism import ONE
from tests.worlds import law_of

SENSES = 2
PARTS = Compound((Discrete(3), Continuous(2)))


class Witness(Brain):
    """A brain that puts out its weights, and remembers all that it perceives."""

    def blocks(self, senses: int, outputs: int) -> dict[str, tuple[int, ...]]:
        return {"output": (outputs,)}

    def memory(self, senses: int, outputs: int) -> int:
        return senses

    def pictured(self, memory: Array, senses: int, outputs: int) -> dict[str, Array]:
        assert memory.shape[1] == senses == 2 * SENSES + outputs
        return {"kept": memory[:, None]}

    def __call__(self, genome: Any, memory: Array, senses: Array) -> tuple[Array, Array]:
        return senses, genome["output"] + senses[:, :1]


def test_the_last_senses_and_the_last_command_are_perceived() -> None:
    """The first of equal outputs is the choice. Amounts are perceived as their tanh."""
    brain, size = Efferent(inner=Witness(), action=PARTS), PARTS.size
    assert brain.layout(SENSES, size).blocks == (("output", (size,)),)
    think = jax.jit(brain.__call__)
    genome = {"output": np.array([[0.1, 0.3, 0.3, -1.0, 1.0]], np.float32)}
    memory = np.zeros((1, brain.memory(SENSES, size)), np.float32)
    first, second = np.array([[0.0, 7]], np.float32), np.array([[0.0, 9]], np.float32)
    memory, output = think(genome, memory, first)
    np.testing.assert_array_equal(output, genome["output"])
    np.testing.assert_array_equal(memory[0, : 2 * SENSES + size], [0, 7] + [0] * (SENSES + size))
    memory, _ = think(genome, memory, second)
    perceived = [0, 9, 0, 7, 0, 1, 0, *np.tanh([-1.0, 1.0])]
    np.testing.assert_allclose(memory[0, : 2 * SENSES + size], perceived, rtol=1e-6)


def test_pictures_show_what_the_inner_brain_remembers() -> None:
    brain, size = Efferent(inner=Witness(), action=PARTS), PARTS.size
    memory = np.arange(2.0 * brain.memory(SENSES, size)).reshape(2, -1)
    pictured: Any = brain.pictured
    (kept,) = pictured(memory, SENSES, size).values()
    np.testing.assert_array_equal(kept[:, 0], memory[:, : 2 * SENSES + size])


def test_the_price_of_learning_is_that_of_the_inner_brain() -> None:
    brain = Efferent(inner=Plastic(hidden=3, price=2.0), action=PARTS)
    senses, outputs = 4, PARTS.size + 1  # one output that decides about copies
    length, last = brain.memory(senses, outputs), senses + PARTS.size
    before, after = np.random.default_rng(3).normal(size=(2, 5, length)).astype(np.float32)
    fast = np.s_[:, length - last - 3 * outputs : length - last]
    expected = 2 * np.abs(after[fast] - before[fast]).sum(axis=1)
    found: Any = jax.jit(brain.spent, static_argnums=(2, 3))(before, after, senses, outputs)
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_children_inherit_what_the_inner_brain_passes_on() -> None:
    forgetful: Any = Efferent(inner=Plastic(), action=PARTS)
    assert forgetful.passed_on(np.ones((1, 99)), 4, 5) is None
    brain, senses, outputs = Efferent(inner=Plastic(hidden=3, inherited=True), action=PARTS), 4, 6
    length, last = brain.memory(senses, outputs), senses + PARTS.size
    memory = np.arange(1, 2 * length + 1, dtype=np.float32).reshape(2, length)
    fast = np.s_[:, length - last - 3 * outputs : length - last]
    expected = np.zeros_like(memory)
    expected[fast] = memory[fast]
    found: Any = jax.jit(brain.passed_on, static_argnums=(1, 2))(memory, senses, outputs)
    np.testing.assert_array_equal(found, expected)


def test_every_brain_has_the_setting() -> None:
    laws = [law_of(brain={"kind": "linear", "efference": on}) for on in (False, True)]
    assert [law.heredity.layout.length for law in laws] == [4 * 2, (4 + 4 + 2) * 2]
    assert [law.memory for law in laws] == [0, 4 + 2]
    assert [law.brain.innate() for law in laws] == [None, None], "they do not learn"
    innate: Any = Efferent(inner=Plastic(), action=PARTS).innate()
    assert innate.inner == Plastic(bound=0.0)


def test_energy_is_perceived_beside_an_efference_copy() -> None:
    brain = {"kind": "plastic", "efference": True, "interoception": True}
    law = law_of(brain=brain, metabolism={"store": 4.0})
    perceived = jax.jit(law.perceived)(np.zeros((1, law.senses - 1)), np.array([2 * ONE]))
    np.testing.assert_array_equal(perceived, [[0, 0, 0, 0, 0.5]])
