"""Randomness: the published cipher, and draws that depend on their names only."""

from fractions import Fraction
from functools import cache
from itertools import product

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from primordia.random.keys import Purpose, below, bits, bits_if, chance, stream, streams, threefry
from primordia.random.wide import Wide, to_host, wide
from tests.chance import binomial, even

FEW = settings(max_examples=25)
word = st.integers(0, 2**32 - 1)
CHANCE, BELOW = jax.jit(chance), jax.jit(below)


@cache
def draws(
    seed: int = 1, purpose: Purpose = Purpose.PLACE, tick: int = 7, cells: int = 1 << 20
) -> Wide:
    key = stream(wide(np.full(1, seed, np.uint64)), purpose, wide(np.full(1, tick, np.uint64)))
    return bits(key, jnp.arange(cells))


@pytest.mark.parametrize(
    ("key", "counter", "expected"),
    [
        (0, 0, 0x6B20015999BA4EFE),
        (2**64 - 1, 2**64 - 1, 0x1CB996FCBB002BE7),
        (0x13198A2E03707344, 0x243F6A8885A308D3, 0xC4923A9C483DF7A0),
    ],
)
def test_the_cipher_gives_the_known_answers_of_random123(
    key: int, counter: int, expected: int
) -> None:
    assert int(to_host(threefry(wide(key), wide(counter)))) == expected


def test_each_purpose_keeps_its_number() -> None:
    """The numbers are part of the format: with another number a run would have other lives."""
    assert {purpose.name: purpose.value for purpose in Purpose} == {
        "REPLICATE": 1, "HAZARD": 2, "PLACE": 3, "MUTATE": 4, "NOISE": 5, "FOUNDER": 6, "GENESIS": 7,
        "BODY": 8, "MOTOR": 9, "EVALUATION": 10, "SHADOW": 11, "REBIRTH": 12, "CONTROL": 13, "MATE": 14,
        "CROSS": 15, "DRIFT": 16,
    }  # fmt: skip


def test_every_part_of_a_draws_name_matters() -> None:
    seeds, ticks = [0, 1, 2**32, 2**64 - 1], [0, 1, 2**32, 10**12]
    names = np.array(list(product(seeds, list(Purpose), ticks)), object)
    keys = [
        to_host(
            stream(wide(np.array(seeds, np.uint64)), purpose, wide(np.full(4, tick, np.uint64)))
        )
        for purpose in Purpose
        for tick in ticks
    ]
    distinct = np.unique(np.concatenate(keys))
    assert len(distinct) == len(names)
    key = wide(distinct[:, None, None])
    words = to_host(bits(key, jnp.arange(16)[:, None], jnp.arange(4)))
    assert len(np.unique(words)) == len(names) * 16 * 4
    for half in (words >> np.uint64(32), words & np.uint64(0xFFFFFFFF)):
        assert len(np.unique(half)) > 0.999 * half.size


def test_bits_if_gives_bits_or_zeros() -> None:
    key = stream(
        wide(np.full((3, 1), 9, np.uint64)), Purpose.PLACE, wide(np.full((3, 1), 2, np.uint64))
    )
    cells, index = jnp.arange(5), jnp.uint32(4)
    needed = bits_if(jnp.bool_(True), key, cells, index)
    assert to_host(needed).tolist() == to_host(bits(key, cells, index)).tolist()
    assert to_host(bits_if(jnp.bool_(False), key, cells, index)).tolist() == [[0] * 5] * 3


@settings(max_examples=200)
@given(st.floats(0, 1, width=32), word)
def test_chance_compares_integers(probability: float, any_word: int) -> None:
    threshold = int(Fraction(probability) * 2**32)
    words = np.array([0, any_word, max(threshold - 1, 0), min(threshold, 2**32 - 1), 2**32 - 1])
    happens = CHANCE(words.astype(np.uint32), np.float32(probability))
    assert happens.tolist() == [int(each) < threshold for each in words]


def test_chance_is_never_at_0_and_always_at_1() -> None:
    words, one = np.array([0, 1, 2**31, 0, 2**32 - 1], np.uint32), np.float32(1)
    assert not np.asarray(CHANCE(words, np.float32(0))).any()
    assert np.asarray(CHANCE(words, one)).all()
    assert np.asarray(CHANCE(words, np.float32(1.5))).all(), "a ratchet may drive it beyond 1"
    assert not np.asarray(CHANCE(words, np.nextafter(one, np.float32(0))))[-1]


@pytest.mark.parametrize(("half", "probability"), [(0, 0.05), (1, 0.9)])
def test_chance_is_true_as_often_as_its_probability_says(half: int, probability: float) -> None:
    words = draws()[half]
    happens = np.asarray(CHANCE(words, np.float32(probability)))
    assert binomial(int(happens.sum()), words.size, probability)


@FEW
@given(st.lists(word, min_size=8, max_size=8), st.integers(1, 2**31))
def test_below_is_the_high_word_of_the_product(words: list[int], n: int) -> None:
    edges = np.array([*words, 0, 2**32 - 1], np.uint32)
    answer = BELOW(edges, np.uint32(n))
    assert answer.dtype == jnp.int32
    assert answer.tolist() == [int(each) * n >> 32 for each in edges]


def test_below_gives_all_numbers_equally_often() -> None:
    assert even(np.bincount(np.asarray(BELOW(draws().hi, np.uint32(31))), minlength=31))


def test_draws_of_neighbouring_names_are_unrelated() -> None:
    def standard(value: Wide) -> np.ndarray:
        return (np.asarray(value.hi, np.float64) / 2**32 - 0.5) * np.sqrt(12)

    base = standard(draws())
    others = {
        "word": standard(Wide(draws().lo, draws().hi)),
        "next cell": np.roll(base, 1),
        "next tick": standard(draws(tick=8)),
        "next seed": standard(draws(seed=2)),
        "other purpose": standard(draws(purpose=Purpose.MUTATE)),
    }
    for name, other in others.items():
        assert abs((base * other).mean()) < 5 / np.sqrt(base.size), name


SEEDS = np.array([3, 2**40, 2**64 - 1], np.uint64)
TICKS = np.array([0, 5, 2**33], np.uint64)
THREE = Purpose.PLACE, Purpose.BODY, Purpose.MATE


def test_streams_drawn_together_equal_those_drawn_one_by_one() -> None:
    keys = streams(wide(SEEDS), wide(TICKS), *THREE)
    for purpose in THREE:
        alone = stream(wide(SEEDS), purpose, wide(TICKS))
        assert to_host(keys[purpose]).tolist() == to_host(alone).tolist()
        some = keys.take(np.array([2, 0]))[purpose]
        assert to_host(some).tolist() == to_host(alone)[[2, 0]].tolist()


def test_keys_are_replaced_for_the_purposes_named_and_for_no_other() -> None:
    keys = streams(wide(SEEDS), wide(TICKS), *THREE)
    other = Wide(*(word + np.uint32(1) for word in keys[Purpose.BODY]))
    replaced = keys.replaced(other, Purpose.PLACE, Purpose.MATE)
    assert replaced.purposes == THREE
    for purpose, expected in zip(THREE, (other, keys[Purpose.BODY], other), strict=True):
        assert to_host(replaced[purpose]).tolist() == to_host(expected).tolist()
