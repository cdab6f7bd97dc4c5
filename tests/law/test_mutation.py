"""Mutation: the noise's distribution, who takes it, and children that NumPy makes bit for bit."""

from statistics import NormalDist

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from primordia.law.mutation import BlockMutation, Mutation, mutates, newborns, noise_index
from primordia.random.gaussian import quantiles
from primordia.random.keys import Purpose, Streams, bits, stream, streams
from primordia.random.wide import Wide, wide
from tests.chance import binomial
from tests.worlds import MEADOW, Lived, config

K, P = 64, 1001
GENETIC = Purpose.MUTATE, Purpose.NOISE, Purpose.FOUNDER
NAMES = ["input", "recurrent", "output"]


def name(number: int, count: int = K) -> Wide:
    return wide(np.full(count, number, np.uint64))


def drawn(seed: int = 3, tick: int = 11, count: int = K) -> Streams:
    return streams(name(seed, count), name(tick, count), *GENETIC)


def noise(which: Wide, cells: np.ndarray | None = None, length: int = P) -> np.ndarray:
    cells = np.arange(len(which.hi)) if cells is None else cells
    return quantiles()[np.asarray(noise_index(which, jnp.asarray(cells), length))]


def test_the_table_is_the_standard_gaussian() -> None:
    table = quantiles()
    assert table.dtype == np.float32
    assert table.shape == (65536,)
    assert (np.diff(table) > 0).all()
    np.testing.assert_array_equal(table, -table[::-1])
    exact = table.astype(float)
    assert exact.mean() == 0
    assert abs(exact.std() - 1) < 1e-4
    assert abs((exact**4).mean() - 3) < 0.01
    assert table[-1] == pytest.approx(4.3249, abs=1e-4)
    shares = [NormalDist().cdf(q) for q in exact[::97]]
    np.testing.assert_allclose(shares, (np.arange(65536)[::97] + 0.5) / 65536, atol=1e-7)


@pytest.mark.parametrize("which", [Purpose.NOISE, Purpose.FOUNDER])
def test_noise_has_the_moments_of_the_gaussian(which: Purpose) -> None:
    values = np.concatenate([noise(drawn(tick=t)[which]).ravel() for t in range(4)]).astype(float)
    n = values.size
    assert abs(values.mean()) < 5 / np.sqrt(n)
    assert abs(values.std() - 1) < 5 / np.sqrt(2 * n) + 1e-4
    assert abs((values**3).mean()) < 5 * np.sqrt(15 / n)
    assert abs((values**4).mean() - 3) < 5 * np.sqrt(96 / n) + 0.01
    assert abs(values).max() > 4


def test_noise_of_different_organisms_is_unrelated() -> None:
    base = noise(drawn()[Purpose.NOISE]).astype(float)
    between = np.corrcoef(base)[np.triu_indices(K, 1)]
    assert abs(between).max() < 5.5 / np.sqrt(P)
    others = {
        "tick": noise(drawn(tick=12)[Purpose.NOISE]),
        "far tick": noise(drawn(tick=11 + 2**32)[Purpose.NOISE]),
        "seed": noise(drawn(seed=4)[Purpose.NOISE]),
        "purpose": noise(drawn()[Purpose.FOUNDER]),
        **{f"weights {lag} apart": np.roll(base, lag, axis=1) for lag in (1, 2, 250, 251, 502)},
    }
    for what, other in others.items():
        assert abs((base * other).mean()) < 5 / np.sqrt(base.size), what


@pytest.mark.parametrize("length", [1, 2, 3, 4, 6, 9])
def test_where_in_the_table_each_weights_noise_stands(length: int) -> None:
    cells = np.array([0, 5, 31])
    which = stream(name(8, 3), Purpose.NOISE, name(4, 3))
    m = -(-length // 4)
    expected = np.zeros((3, length), int)
    for row, cell in enumerate(cells):
        for i in range(length):
            pair = bits(which.take(row), cell, i % m)
            word = int((pair.hi, pair.hi, pair.lo, pair.lo)[i // m])
            expected[row, i] = word >> 16 if (i // m) % 2 else word & 0xFFFF
    np.testing.assert_array_equal(noise_index(which, jnp.asarray(cells), length), expected)


def test_noise_does_not_depend_on_who_else_is_born() -> None:
    all_of_them = noise(drawn()[Purpose.NOISE])
    some = np.array([63, 2, 40])
    np.testing.assert_array_equal(noise(drawn(count=3)[Purpose.NOISE], some), all_of_them[some])


@pytest.mark.parametrize("probability", [0.0, 0.1, 0.5, 0.999, 1.0])
def test_the_share_of_mutants(probability: float) -> None:
    count = 100_000
    cells, each = jnp.arange(count), jnp.full((count, 3), probability, jnp.float32)
    taken = np.asarray(mutates(drawn(count=count)[Purpose.MUTATE], cells, each))
    assert binomial(int(taken[:, 0].sum()), count, probability)
    np.testing.assert_array_equal(taken, np.tile(taken[:, :1], 3))


def test_one_draw_decides_for_all_blocks() -> None:
    count = 100_000
    each = jnp.tile(jnp.array([0.0, 0.2, 0.7, 1.0], jnp.float32), (count, 1))
    taken = np.asarray(mutates(drawn(count=count)[Purpose.MUTATE], jnp.arange(count), each))
    assert not taken[:, 0].any()
    assert taken[:, 3].all()
    assert binomial(int(taken[:, 1].sum()), count, 0.2)
    assert binomial(int(taken[:, 2].sum()), count, 0.7)
    assert taken[taken[:, 1], 2].all(), "a block with the lower probability mutates alone"


def test_blocks_have_their_own_settings_where_given() -> None:
    mutation = Mutation(
        probability=0.3,
        scale=0.02,
        blocks={
            "input": BlockMutation(probability=0.0),
            "output": BlockMutation(scale=0.5, founder_scale=1.0),
        },
    )
    assert mutation.of_blocks("probability", NAMES) == [0.0, 0.3, 0.3]
    assert mutation.of_blocks("scale", NAMES) == [0.02, 0.02, 0.5]
    assert mutation.of_blocks("founder_scale", NAMES) == [0.01, 0.01, 1.0]
    none = Mutation(blocks={"recurrent": BlockMutation(probability=0, scale=0, founder_scale=0)})
    assert none.of_blocks("probability", NAMES) == [0.5, 0.0, 0.5]
    assert none.of_blocks("scale", NAMES) == [0.01, 0.0, 0.01]
    assert none.of_blocks("founder_scale", NAMES) == [0.01, 0.0, 0.01]


@jax.jit
def compiled(
    parents: jax.Array, index: jax.Array, takes: jax.Array, scale: jax.Array, founder: jax.Array
) -> jax.Array:
    return newborns(parents, jnp.asarray(quantiles())[index], takes, scale, founder, FOUNDER)


FOUNDER = np.full(P, 0.3, np.float32)


def same_bits(a: np.ndarray, b: np.ndarray) -> None:
    np.testing.assert_array_equal(np.asarray(a).view(np.uint32), np.asarray(b).view(np.uint32))


@settings(max_examples=40)
@given(
    st.integers(0, 2**32),
    st.floats(0, 1e3, width=32, allow_subnormal=False).map(lambda x: x if x > 1e-30 else 0.0),
    st.floats(0, 1),
    st.booleans(),
)
def test_children_are_those_of_numpy_bit_for_bit(
    number: int, scale: float, share: float, scale_differs: bool
) -> None:
    rng = np.random.default_rng(number)
    parents = (rng.normal(size=(K, P)) * rng.choice([1e-3, 1, 100], (K, 1))).astype(np.float32)
    parents[0, :5] = [0.0, -0.0, np.nan, np.inf, -np.inf]
    index = rng.integers(0, 65536, (K, P), dtype=np.int32)
    takes = rng.random((K, P)) < share
    scales = np.full((K, P), scale, np.float32)
    if scale_differs:
        scales *= rng.random((K, P), np.float32)
    founder = rng.random(K) < 0.2
    standard = quantiles()[index]
    with np.errstate(invalid="ignore"):
        inherited = np.where(takes, parents + standard * scales, parents)
    expected = np.where(founder[:, None], standard * np.float32(0.3), inherited)
    same_bits(newborns(parents, standard, takes, scales, founder, FOUNDER), expected)
    same_bits(compiled(parents, index, takes, scales, founder), expected)


def test_a_copy_is_its_parent_to_the_last_bit() -> None:
    rng = np.random.default_rng(0)
    parents = rng.integers(0, 2**32, (K, P), dtype=np.uint64).astype(np.uint32).view(np.float32)
    nothing, nobody = np.zeros((K, P), bool), np.zeros(K, bool)
    index, scale = np.zeros((K, P), np.int32), np.full((K, P), 0.5, np.float32)
    same_bits(compiled(parents, index, nothing, scale, nobody), parents)


SCALES, PROBABILITIES = [0.3, 0.25, 0.01], [0.0, 0.6, 0.3]
FOUNDER_SCALES = [1.0, 0.1, 1.0]


@pytest.fixture(scope="module")
def family() -> Lived:
    """A world in which nobody dies, so that every parent is there to be compared with."""
    blocks = {
        name: {"scale": scale, "probability": probability}
        for name, scale, probability in zip(NAMES, SCALES, PROBABILITIES, strict=True)
    }
    blocks["recurrent"]["founder_scale"] = FOUNDER_SCALES[1]
    mutation = {"founder_scale": FOUNDER_SCALES[0], "blocks": blocks}
    values = {"cells": 256, "replication": 0.3, "placement": {"topology": "well-mixed"}}
    lived = Lived(config(MEADOW, mutation=mutation, **values), 100)
    assert lived.table("births")["id"].tolist() == list(range(256))
    return lived


def weights(family: Lived) -> dict[str, np.ndarray]:
    """Blocks of weights in order, a row an organism in order of birth."""
    cells, genome = family.table("births")["cell"], family.engine.state.world.organisms.genome
    return {block: np.asarray(genome[block]).reshape(256, -1)[cells] for block in NAMES}


def test_children_in_a_world_differ_from_their_parents_as_their_blocks_say(family: Lived) -> None:
    births, genome = family.table("births"), weights(family)
    parents = births["parent"][1:].astype(int)
    change = {name: block[1:] - block[parents] for name, block in genome.items()}
    moved = {name: (each != 0).any(axis=1) for name, each in change.items()}
    assert not moved["input"].any()
    assert binomial(int(moved["recurrent"].sum()), 255, 0.6)
    assert binomial(int(moved["output"].sum()), 255, 0.3)
    assert moved["recurrent"][moved["output"]].all()
    np.testing.assert_array_equal(births["cause"][1:] == "mutant", moved["recurrent"])
    for name, scale in (("recurrent", 0.25), ("output", 0.01)):
        values = change[name][moved[name]]
        assert values.std() == pytest.approx(scale, rel=5 / np.sqrt(2 * values.size))
    for block, scale in zip(genome.values(), FOUNDER_SCALES, strict=True):
        assert block[0].std() == pytest.approx(scale, rel=5 / np.sqrt(2 * block[0].size))


def test_genomes_in_a_world_are_those_of_numpy_bit_for_bit(family: Lived) -> None:
    births = family.table("births")
    genome = weights(family)
    sizes = [block.shape[1] for block in genome.values()]
    lived = np.concatenate(list(genome.values()), axis=1)
    cells, ticks = jnp.asarray(births["cell"]), wide(births["tick"])
    drawn = streams(name(family.config.seed, 256), ticks, *GENETIC)
    takes = np.asarray(
        mutates(drawn[Purpose.MUTATE], cells, jnp.array([PROBABILITIES] * 256, jnp.float32))
    )
    takes, scale = np.repeat(takes, sizes, axis=1), np.repeat(np.float32(SCALES), sizes)
    spread = np.repeat(np.float32(FOUNDER_SCALES), sizes)
    same_bits((noise(drawn[Purpose.FOUNDER], cells, lived.shape[1]) * spread)[0], lived[0])
    parents = lived[births["parent"][1:].astype(int)]
    change = noise(drawn[Purpose.NOISE], cells, lived.shape[1])[1:] * scale
    same_bits(np.where(takes[1:], parents + change, parents), lived[1:])
