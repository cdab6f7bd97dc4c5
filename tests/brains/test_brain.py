"""Brains against their formulas in NumPy, and each organism by itself."""

from math import prod

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from primordia.brains.contract import Brain, BrainSettings, Linear, genome_length, join, split

SENSES, HIDDEN, OUTPUTS, N = 5, 12, 3, 64
KINDS = ["recurrent", "feed-forward"]


def a_brain(kind: str) -> Brain:
    return BrainSettings(kind=kind, hidden=HIDDEN).build(SENSES, OUTPUTS)


def organisms(brain: Brain) -> tuple[dict[str, np.ndarray], np.ndarray, np.ndarray]:
    """Genomes, memories and senses of N organisms."""
    rng = np.random.default_rng(1)

    def normal(*shape: int) -> np.ndarray:
        return rng.normal(size=shape).astype(np.float32)

    genome = {name: normal(N, *shape) for name, shape in brain.blocks.items()}
    return genome, normal(N, brain.memory), normal(N, SENSES)


def times(weights: np.ndarray, x: np.ndarray) -> np.ndarray:
    """W x in float64; the longer side of W (K, *) is stored last, inputs first if they are equal."""
    inputs_first = weights.shape[1] == x.shape[1]
    return np.einsum("kio,ki->ko" if inputs_first else "koi,ki->ko", weights.astype(float), x)


@pytest.mark.parametrize(
    ("inputs", "outputs", "shape"),
    [(4, 32, (4, 32)), (32, 4, (4, 32)), (7, 7, (7, 7)), (128, 32, (32, 128)), (1, 1, (1, 1))],
)
def test_linear_stores_the_longer_axis_last(
    inputs: int, outputs: int, shape: tuple[int, int]
) -> None:
    linear = Linear(inputs, outputs)
    assert linear.shape == shape
    rng = np.random.default_rng(0)
    weights = rng.normal(size=(3, *shape)).astype(np.float32)
    x = rng.normal(size=(3, inputs)).astype(np.float32)
    np.testing.assert_allclose(linear(weights, x), times(weights, x), rtol=1e-4, atol=1e-4)


def test_the_recurrent_brain_remembers() -> None:
    brain = a_brain("recurrent")
    genome, memory, senses = organisms(brain)
    assert brain.memory == HIDDEN
    expected = np.zeros((N, HIDDEN))
    now = jnp.zeros((N, HIDDEN), jnp.float32)
    for tick in range(4):
        seen = senses * np.float32(1 + tick)
        now, output = brain(genome, now, seen)
        drive = times(genome["input"], seen) + times(genome["recurrent"], expected)
        expected = np.tanh(drive)
        np.testing.assert_allclose(now, expected, atol=2e-5)
        np.testing.assert_allclose(output, times(genome["output"], expected), atol=2e-4)
    other, _ = brain(genome, memory, senses)
    assert np.abs(np.asarray(other) - brain(genome, -memory, senses)[0]).max() > 0.1


def test_the_feed_forward_brain_does_not() -> None:
    brain = a_brain("feed-forward")
    genome, memory, senses = organisms(brain)
    assert brain.memory == 0
    after, output = brain(genome, memory, senses)
    assert after.shape == (N, 0)
    expected = times(genome["output"], np.tanh(times(genome["input"], senses)))
    np.testing.assert_allclose(output, expected, atol=2e-4)


@pytest.mark.parametrize("kind", KINDS)
def test_a_flat_genome_is_its_blocks_in_order(kind: str) -> None:
    brain = a_brain(kind)
    length = genome_length(brain)
    assert length == sum(prod(shape) for shape in brain.blocks.values())
    flat = np.random.default_rng(0).normal(size=(N, length)).astype(np.float32)
    blocks = {name: np.asarray(block) for name, block in split(brain, flat).items()}
    assert {name: block.shape for name, block in blocks.items()} == {
        name: (N, *shape) for name, shape in brain.blocks.items()
    }
    np.testing.assert_array_equal(join(brain, blocks), flat)
    in_order = np.concatenate([blocks[name][5].ravel() for name in brain.blocks])
    np.testing.assert_array_equal(in_order, flat[5])
    one = split(brain, flat[5])
    for name, block in blocks.items():
        np.testing.assert_array_equal(one[name], block[5])


def test_blocks_of_the_papers_brain() -> None:
    assert list(a_brain("recurrent").blocks) == ["input", "recurrent", "output"]
    assert list(a_brain("feed-forward").blocks) == ["input", "output"]
    paper = BrainSettings().build(4, 2)
    assert genome_length(paper) == 4 * 32 + 32 * 32 + 32 * 2


@pytest.mark.parametrize("kind", KINDS)
def test_an_organism_thinks_the_same_whoever_else_does(kind: str) -> None:
    brain = a_brain(kind)
    genome, memory, senses = organisms(brain)
    think = jax.jit(brain)
    after, output = (np.asarray(each) for each in think(genome, memory, senses))
    order = np.random.default_rng(3).permutation(N)
    for some in (order, np.arange(1), np.arange(3), order[:31], order[:32]):
        picked = {name: block[some] for name, block in genome.items()}
        few_after, few_output = think(picked, memory[some], senses[some])
        np.testing.assert_array_equal(few_after, after[some])
        np.testing.assert_array_equal(few_output, output[some])


@pytest.mark.parametrize("kind", KINDS)
def test_a_broken_genome_breaks_nobody_else(kind: str) -> None:
    brain = a_brain(kind)
    genome, memory, senses = organisms(brain)
    think = jax.jit(brain)
    _, whole = think(genome, memory, senses)
    broken = {name: block.copy() for name, block in genome.items()}
    broken["input"][7] = np.nan
    broken["output"][9, 0, 0] = np.inf
    _, output = (np.asarray(each) for each in think(broken, memory, senses))
    assert np.isnan(output[7]).all()
    assert not np.isfinite(output[9]).all()
    others = np.delete(np.arange(N), [7, 9])
    np.testing.assert_array_equal(output[others], np.asarray(whole)[others])
