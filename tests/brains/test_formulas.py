"""Brains compared with their formulas in NumPy, in float64."""

from itertools import pairwise
from typing import Any

import jax
import numpy as np
import pytest

from primordia.brains.contract import Brain
from primordia.brains.feedforward import FeedForward
from primordia.brains.gated import Gated
from primordia.brains.linear import Linear
from primordia.brains.plastic import COEFFICIENTS, Plastic
from primordia.brains.recurrent import Recurrent
from primordia.compiled import shared
from tests.brains.test_layers import times

SENSES, HIDDEN, OUTPUTS, N = 5, 12, 3, 64


def thought(brain: Brain, ticks: int = 4) -> tuple:
    """Return genomes, senses (T, N, S), memories (T, N, M) and outputs (T, N, A) of N organisms."""
    rng, shape = np.random.default_rng(1), (ticks, N, SENSES)
    layout = brain.layout(SENSES, OUTPUTS)
    genome: Any = layout.split(rng.normal(size=(N, layout.length)).astype(np.float32))
    senses = rng.normal(size=shape).astype(np.float32)
    think, seen = shared(_think, brain), []
    memory = np.zeros((N, brain.memory(SENSES, OUTPUTS)), np.float32)
    for each in senses:
        memory, output = (np.asarray(part) for part in think(genome, memory, each))
        seen.append((memory, output))
    return genome, senses, *(np.stack(each) for each in zip(*seen, strict=True))


def _think(brain: Brain, genome: Any, memory: Any, senses: Any) -> tuple:
    return brain(genome, memory, senses)


def bias(genome: dict[str, np.ndarray], name: str) -> np.ndarray | int:
    return genome.get(f"{name}_bias", 0)


def blocks(brain: Brain) -> list[str]:
    return brain.layout(SENSES, OUTPUTS).names


def test_the_papers_brain_has_the_papers_blocks() -> None:
    assert blocks(Recurrent()) == ["input", "recurrent", "output"]
    assert blocks(FeedForward()) == ["input", "output"]
    assert Recurrent().layout(4, 2).length == 4 * 32 + 32 * 32 + 32 * 2
    with_biases = ["input", "input_bias", "recurrent", "output", "output_bias"]
    assert blocks(Recurrent(biases=True)) == with_biases


def test_the_recurrent_brain_follows_its_formula() -> None:
    g, senses, memories, outputs = thought(Recurrent(hidden=HIDDEN, biases=True))
    h = np.zeros((N, HIDDEN))
    for x, memory, output in zip(senses, memories, outputs, strict=True):
        h = np.tanh(times(g["input"], x) + bias(g, "input") + times(g["recurrent"], h))
        np.testing.assert_allclose(memory, h, atol=5e-5)
        y = times(g["output"], h) + bias(g, "output")
        np.testing.assert_allclose(output, y, atol=5e-4)


def test_the_feed_forward_brain_follows_its_formula() -> None:
    g, senses, memories, outputs = thought(FeedForward(hidden=HIDDEN, biases=True))
    assert memories.size == 0
    for x, output in zip(senses, outputs, strict=True):
        hidden = np.tanh(times(g["input"], x) + bias(g, "input"))
        y = times(g["output"], hidden) + bias(g, "output")
        np.testing.assert_allclose(output, y, atol=5e-4)


def test_the_linear_brain_follows_its_formula() -> None:
    g, senses, memories, outputs = thought(Linear(biases=True))
    assert memories.size == 0
    for x, output in zip(senses, outputs, strict=True):
        np.testing.assert_allclose(output, times(g["output"], x) + bias(g, "output"), atol=5e-5)


def test_the_gated_brain_follows_its_formula() -> None:
    g, senses, memories, outputs = thought(Gated(hidden=HIDDEN, biases=True))
    assert len(g) == 11
    h = np.zeros((N, HIDDEN))

    def drive(part: str, x: np.ndarray, h: np.ndarray) -> np.ndarray:
        perceived = times(g[f"{part}_input"], x) + bias(g, f"{part}_input")
        return perceived + times(g[f"{part}_recurrent"], h)

    for x, memory, output in zip(senses, memories, outputs, strict=True):
        r, z = (1 / (1 + np.exp(-drive(part, x, h))) for part in ("reset", "update"))
        h = z * h + (1 - z) * np.tanh(drive("candidate", x, r * h))
        np.testing.assert_allclose(memory, h, atol=5e-5)
        y = times(g["output"], h) + bias(g, "output")
        np.testing.assert_allclose(output, y, atol=5e-4)


def test_a_closed_update_gate_keeps_a_memory_for_ever() -> None:
    brain = Gated(hidden=HIDDEN, biases=True)
    layout = brain.layout(SENSES, OUTPUTS)
    genome = layout.split(np.random.default_rng(0).normal(size=(N, layout.length)).astype("f4"))
    genome["update_input_bias"][:] = 1000
    memory = after = np.random.default_rng(1).random((N, HIDDEN), np.float32)
    for _ in range(20):
        after, _ = shared(_think, brain)(genome, after, np.ones((N, SENSES), np.float32))
    np.testing.assert_array_equal(after, memory)


def rows(block: np.ndarray, hidden: int) -> np.ndarray:
    """Return the weights of an output layer as (N, hidden, outputs), in float64."""
    inputs_first = block.shape[1] == hidden or block.shape[1] == 1
    return (block if inputs_first else block.transpose(0, 2, 1)).astype(float)


LEARNING: dict[str, Any] = {"decay": 0.3, "bound": 2.0, "gain": 1.5}
FEW = Plastic(hidden=2, coefficients="connection", activity="winner", **LEARNING)


@pytest.mark.parametrize(
    "brain",
    [FEW, Plastic(hidden=12, coefficients="layer", activity="graded", **LEARNING)],
    ids=["few", "many"],
)
def test_the_plastic_brain_follows_its_formula(brain: Plastic) -> None:
    """All fast weights are 0 at birth, and some reach the bound."""
    hidden = brain.hidden
    g, senses, memories, outputs = thought(brain, ticks=6)
    slow = rows(g["output"], hidden)
    a, b, c, d, rate = (rows(g[name], hidden) for name in COEFFICIENTS)
    h, p, x = np.zeros((N, hidden)), np.zeros((N, OUTPUTS)), np.zeros((N, SENSES))
    fast = np.zeros((N, hidden, OUTPUTS))
    for now, memory, output in zip(senses, memories, outputs, strict=True):
        m = np.tanh(20 * times(g["modulator"], now - x))[:, None]
        pre, post = h[:, :, None], p[:, None]
        change = m * (1 + np.tanh(rate)) * (a * pre * post + b * pre + c * post + d)
        fast = np.clip(0.7 * fast + change, -2, 2)
        x, h = now, np.tanh(1.5 * times(g["input"], now))
        y = np.einsum("nha,nh->na", slow + fast, h)
        np.testing.assert_allclose(output, y, atol=1e-3)
        p = (
            np.tanh(y)
            if brain.activity == "graded"
            else np.where(y == y.max(axis=1)[:, None], 1, -1)
        )
        kept = memory[:, SENSES + hidden + OUTPUTS :].reshape(g["output"].shape)
        np.testing.assert_allclose(rows(kept, hidden), fast, atol=1e-3)
        (shown,) = brain.pictured(memory, SENSES, OUTPUTS).values()
        np.testing.assert_allclose(shown, fast.swapaxes(1, 2) / 2, atol=1e-3)
    assert (np.abs(fast) == 2).mean() > 0.05


def test_learning_costs_energy_for_each_change_of_a_fast_weight() -> None:
    """The last numbers of a memory are the fast weights."""
    *_, memories, _ = thought(FEW, ticks=6)
    size = 2 * OUTPUTS
    spent: Any = jax.jit(FEW.model_copy(update={"price": 0.25}).spent, static_argnums=(2, 3))
    for before, after in pairwise(memories):
        found = spent(before, after, SENSES, OUTPUTS)
        change = np.abs(after[:, -size:] - before[:, -size:]).sum(axis=1)
        np.testing.assert_allclose(found, 0.25 * change, rtol=1e-5)
    assert FEW.spent(before, after, SENSES, OUTPUTS) is None


def test_children_inherit_fast_weights_and_nothing_else() -> None:
    *_, memories, _ = thought(FEW, ticks=6)
    size, heir = 2 * OUTPUTS, FEW.model_copy(update={"inherited": True})
    passed_on: Any = jax.jit(heir.passed_on, static_argnums=(1, 2))
    found = passed_on(memories[-1], SENSES, OUTPUTS)
    assert memories[-1][:, :-size].all()
    assert not found[:, :-size].any()
    np.testing.assert_array_equal(found[:, -size:], memories[-1][:, -size:])
    for other in (FEW, Recurrent(hidden=2)):
        assert other.passed_on(memories[-1], SENSES, OUTPUTS) is None


def test_a_plastic_brain_with_a_bound_of_0_does_not_learn() -> None:
    brain = Plastic(hidden=HIDDEN, bound=0.0, gain=1.0)
    g, senses, memories, outputs = thought(brain)
    assert brain.pictured(memories[-1], SENSES, OUTPUTS) == {}
    for x, output in zip(senses, outputs, strict=True):
        hidden = np.tanh(times(g["input"], x))
        np.testing.assert_allclose(output, times(g["output"], hidden), atol=5e-4)
