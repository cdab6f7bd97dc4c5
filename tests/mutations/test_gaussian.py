"""Gaussian mutation: its noise, the share of mutants, and children equal to those made by NumPy."""

from typing import Any

import jax
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.brains.layout import Layout
from primordia.compiled import shared
from primordia.mutations.calibrated import Calibrated
from primordia.mutations.contract import Draws, Family
from primordia.mutations.gaussian import Block, Gaussian
from primordia.mutations.noise import noise_index
from primordia.random.gaussian import quantiles, sparse
from primordia.random.keys import Purpose, Streams, bits, chance, stream, streams
from primordia.random.wide import Wide, wide
from tests.mutations.families import inherited
from tests.worlds import RING, Lived, config

K, P = 64, 1001
GENETIC = Purpose.MUTATE, Purpose.NOISE, Purpose.FOUNDER
NAMES = ["input", "recurrent", "output"]
LAYOUT = Layout((("input", (3, 7)), ("recurrent", (31, 10)), ("output", (10, 67))))


def name(number: int, count: int = K) -> Wide:
    return wide(np.full(count, number, np.uint64))


def drawn(seed: int = 3, tick: int = 11, count: int = K) -> Streams:
    return streams(name(seed, count), name(tick, count), *GENETIC)


def noise(which: Wide, cells: np.ndarray | None = None, length: int = P) -> np.ndarray:
    cells = np.arange(len(which.hi)) if cells is None else cells
    return quantiles()[index(which, cells, length)]


def index(which: Wide, cells: np.ndarray, length: int) -> np.ndarray:
    return np.asarray(INDEX(which, cells, length))


INDEX, CHANCE = jax.jit(noise_index, static_argnums=2), jax.jit(chance)


@pytest.mark.parametrize("length", [3, 4, 9])
def test_each_weight_takes_its_noise_from_its_place_in_the_table(length: int) -> None:
    cells = np.array([0, 5, 31])
    which = stream(name(8, 3), Purpose.NOISE, name(4, 3))
    m = -(-length // 4)
    expected = np.zeros((3, length), int)
    for row, cell in enumerate(cells):
        for i in range(length):
            pair = bits(which.take(row), cell, i % m)
            word = int((pair.hi, pair.hi, pair.lo, pair.lo)[i // m])
            expected[row, i] = word >> 16 if (i // m) % 2 else word & 0xFFFF
    np.testing.assert_array_equal(index(which, cells, length), expected)


def rates(layout: Layout, probability: object, scale: object, count: int) -> dict[str, np.ndarray]:
    """Return the rates of K equal births, from one value for all blocks or one for each."""
    table = {}
    for field, values in (("probability", probability), ("scale", scale)):
        each = np.broadcast_to(np.array(values, np.float32), len(layout.names))
        for block, value in zip(layout.names, each, strict=True):
            table[f"blocks.{block}.{field}"] = np.full(count, value, np.float32)
    return table


def children(
    layout: Layout,
    parents: np.ndarray,
    probability: object,
    scale: object = 1.0,
    density: float = 1.0,
) -> tuple[np.ndarray, np.ndarray]:
    count = len(parents)
    draws = Draws(drawn(count=count), np.arange(count, dtype=np.int32))
    notes, table = np.zeros((count, 0), np.int32), rates(layout, probability, scale, count)
    mutation = Gaussian(density=density)
    return inherited(mutation, layout, Family(parents, notes, table, draws))


def test_a_block_has_its_own_settings_where_they_are_given() -> None:
    blocks = {"input": Block(probability=0.0), "output": Block(scale=0.5, founder_scale=1.0)}
    mutation = Gaussian(probability=0.3, scale=0.02, blocks=blocks)
    assert mutation.rates(LAYOUT) == {
        "blocks.input.probability": 0.0,
        "blocks.recurrent.probability": 0.3,
        "blocks.output.probability": 0.3,
        "blocks.input.scale": 0.02,
        "blocks.recurrent.scale": 0.02,
        "blocks.output.scale": 0.5,
    }
    none = Gaussian(blocks={"recurrent": Block(probability=0, scale=0)}).rates(LAYOUT)
    assert [none[f"blocks.{name}.probability"] for name in NAMES] == [0.5, 0.0, 0.5]
    assert [none[f"blocks.{name}.scale"] for name in NAMES] == [0.01, 0.0, 0.01]


def test_a_season_of_the_whole_changes_blocks_without_a_value_of_their_own() -> None:
    mutation = Gaussian(blocks={"output": Block(scale=0.5)})
    assert mutation.governed("scale", LAYOUT) == ["blocks.input.scale", "blocks.recurrent.scale"]
    assert len(mutation.governed("probability", LAYOUT)) == 3
    none = Gaussian(blocks={"input": Block(probability=0.0), "output": Block(scale=0.0)})
    assert none.governed("scale", LAYOUT) == ["blocks.input.scale", "blocks.recurrent.scale"]
    assert [rate.split(".")[1] for rate in none.governed("probability", LAYOUT)] == NAMES[1:]
    assert mutation.governed("blocks.output.scale", LAYOUT) == ["blocks.output.scale"]
    for unknown in ("founder_scale", "blocks.input.founder_scale", "blocks.hidden.scale", "blocks"):
        assert mutation.governed(unknown, LAYOUT) == []


@pytest.mark.parametrize("kind", [Gaussian, Calibrated])
def test_each_block_with_values_of_its_own_must_be_a_block_of_the_brain(kind: Any) -> None:
    values: dict[str, Any] = {"founder_scale": 0.5}
    kind(blocks=dict.fromkeys(NAMES, values)).check(LAYOUT)
    for names in (["hidden"], [*NAMES, "hidden"], ["hidden", "output"]):
        with pytest.raises(
            ValueError, match=r"no block 'hidden'; it has input, recurrent, output$"
        ):
            kind(blocks=dict.fromkeys(names, values)).check(LAYOUT)


def same_bits(a: np.ndarray, b: np.ndarray) -> None:
    np.testing.assert_array_equal(np.asarray(a).view(np.uint32), np.asarray(b).view(np.uint32))


@given(
    st.integers(0, 2**32),
    st.floats(0, 1e3, width=32, allow_subnormal=False).map(lambda x: x if x > 1e-30 else 0.0),
    st.lists(st.floats(0, 1), min_size=3, max_size=3),
)
def test_children_are_those_of_numpy_bit_for_bit(
    number: int, scale: float, probability: list[float]
) -> None:
    rng = np.random.default_rng(number)
    parents = (rng.normal(size=(K, P)) * rng.choice([1e-3, 1, 100], (K, 1))).astype(np.float32)
    parents[0, :5] = [0.0, -0.0, np.nan, np.inf, -np.inf]
    scales = np.float32(scale) * np.array([1, 0.3, 0.7], np.float32)
    word = bits(drawn()[Purpose.MUTATE], np.arange(K)).hi
    takes = np.asarray(CHANCE(np.asarray(word)[:, None], np.float32([probability])))
    change = noise(drawn()[Purpose.NOISE]) * np.repeat(scales, LAYOUT.sizes)
    with np.errstate(invalid="ignore"):
        expected = np.where(np.repeat(takes, LAYOUT.sizes, axis=1), parents + change, parents)
    genomes, mutated = children(LAYOUT, parents, probability, scales)
    same_bits(genomes, expected)
    np.testing.assert_array_equal(mutated, takes.any(axis=1))


@pytest.mark.parametrize("density", [0.5, 0.01, 2**-15])
def test_a_sparse_mutation_changes_a_share_of_the_weights_by_gaussian_noise(density: float) -> None:
    table, full = sparse(density), quantiles()
    changed = table[table != 0]
    assert len(changed) == pytest.approx(density * 65536, abs=1)
    assert np.isin(changed, full).all()
    np.testing.assert_array_equal(table, -table[::-1])
    if density > 0.001:
        assert changed.std() == pytest.approx(1, abs=0.01)


def test_children_have_the_noise_of_a_sparse_mutation() -> None:
    table = sparse(0.01)
    genomes, mutated = children(LAYOUT, np.ones((K, P), np.float32), 1.0, 0.5, 0.01)
    place = index(drawn()[Purpose.NOISE], np.arange(K), P)
    same_bits(genomes, 1 + table[place] * np.float32(0.5))
    assert mutated.all()


def test_founders_are_noise_of_their_blocks_scales() -> None:
    own = {"recurrent": Block(founder_scale=0.02), "output": Block(founder_scale=0.7)}
    mutation = Gaussian(founder_scale=0.3, blocks=own)
    scales = np.repeat(np.array([0.3, 0.02, 0.7], np.float32), LAYOUT.sizes)
    genomes = shared(Gaussian.founders, mutation, LAYOUT)(Draws(drawn(), np.arange(K)))
    same_bits(np.asarray(genomes), noise(drawn()[Purpose.FOUNDER]) * scales)


SCALES, PROBABILITIES = [0.3, 0.25, 0.01], [0.0, 0.6, 0.3]


def test_genomes_in_a_world_are_those_of_numpy_bit_for_bit() -> None:
    """No organism dies, so that every child can be compared with its parent."""
    lived = Lived(config(RING), 1)
    lived.change({"replication": 1.0, "hazard": 0.0})
    for block, scale, probability in zip(NAMES, SCALES, PROBABILITIES, strict=True):
        own = {"scale": scale, "probability": probability}
        lived.change({f"mutation.blocks.{block}.{rate}": value for rate, value in own.items()})
    lived.advance_to(100)
    births, layout = lived.table("births"), lived.engine.law.heredity.layout
    assert len(births["id"]) == 48
    cells, worlds = births["cell"].astype(np.int32), births["world"].astype(int)
    genomes = lived.genomes()[12 * worlds + cells]
    seeds = np.array(lived.config.world_seeds, np.uint64)[worlds]
    drawn = streams(wide(seeds), wide(births["tick"]), *GENETIC)
    word = bits(drawn[Purpose.MUTATE], cells).hi
    takes = np.asarray(CHANCE(np.asarray(word)[:, None], np.float32([PROBABILITIES])))
    mutant = np.repeat(takes, layout.sizes, axis=1)
    scale = np.repeat(np.float32(SCALES), layout.sizes)
    of = {key: row for row, key in enumerate(zip(worlds, births["id"], strict=True))}
    parents = births["parent"]
    child = ~np.isnan(parents)
    assert child.sum() == 44
    rows = [
        of[world, int(parent)] for world, parent in zip(worlds[child], parents[child], strict=True)
    ]
    founders = noise(drawn[Purpose.FOUNDER], cells, layout.length) * np.float32(0.01)
    same_bits(genomes[~child], founders[~child])
    change = noise(drawn[Purpose.NOISE], cells, layout.length) * scale
    expected = np.where(mutant[child], genomes[rows] + change[child], genomes[rows])
    same_bits(genomes[child], expected)
    np.testing.assert_array_equal(births["cause"][child] == "mutant", takes[child].any(axis=1))
