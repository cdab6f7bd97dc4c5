"""Wide counts compared with Python's integers, modulo 2^64."""

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from primordia.random.wide import (
    Wide,
    happened,
    largest,
    modulo,
    never,
    select,
    signed,
    times,
    to_float,
    to_host,
    total,
    wide,
    zero,
)

ALL = 2**64
FEW = settings(max_examples=30)
TOTAL = jax.jit(total, static_argnums=1)
TIMES, TO_FLOAT, MODULO = jax.jit(times), jax.jit(to_float), jax.jit(modulo, static_argnums=1)
LARGEST, UNTIL, PLUS = jax.jit(largest, static_argnums=1), jax.jit(Wide.until), jax.jit(Wide.plus)
ADD, SUBTRACT, SIGNED = jax.jit(Wide.__add__), jax.jit(Wide.__sub__), jax.jit(signed)


@jax.jit
def compared(a: Wide, b: Wide) -> tuple[jax.Array, jax.Array, Wide]:
    return a.at_least(b), a.equals(b), select(a.at_least(b), a, b)


def eight(most: int) -> st.SearchStrategy[list[int]]:
    """Return eight numbers below `most`, often at the edges of words."""
    edges = [
        n + d for n in (0, 2**16, 2**31, 2**32, 2**48, 2**63, 2**64) for d in (-2, -1, 0, 1, 2)
    ]
    near = st.sampled_from([n for n in edges if 0 <= n < most])
    return st.lists(st.one_of(near, st.integers(0, most - 1)), min_size=8, max_size=8)


counts = eight(ALL)
words = eight(2**32)


def whole(values: list[int]) -> Wide:
    return wide(np.array(values, np.uint64))


def ints(value: Wide) -> list[int]:
    assert value.hi.dtype == value.lo.dtype == jnp.uint32
    return to_host(value).tolist()


def uint32(values: list[int]) -> jax.Array:
    return jnp.asarray(np.array(values, np.uint32))


@FEW
@given(counts)
def test_numbers_come_back_to_the_host_unchanged(a: list[int]) -> None:
    value = whole(a)
    assert ints(value) == a
    assert np.asarray(value.hi).tolist() == [n >> 32 for n in a]
    assert np.asarray(value.lo).tolist() == [n & 0xFFFFFFFF for n in a]
    assert int(to_host(wide(a[0]))) == a[0]
    on_host = value.map(np.asarray)
    assert ints(on_host.map(lambda word: word[::-1])) == a[::-1]
    assert ints(on_host.take(np.array([7, 0]))) == [a[7], a[0]]


@FEW
@given(st.lists(st.integers(-(2**63), 2**63 - 1), min_size=8, max_size=8))
def test_negative_numbers_wrap(a: list[int]) -> None:
    assert ints(wide(np.array(a, np.int64))) == [n % ALL for n in a]


def test_a_list_of_ints_keeps_every_bit() -> None:
    values = [2**64 - 1, 5, 2**63 + 1]
    assert ints(wide(values)) == values


@FEW
@given(counts, counts)
def test_sums_and_differences_are_those_of_integers(a: list[int], b: list[int]) -> None:
    assert ints(ADD(whole(a), whole(b))) == [(x + y) % ALL for x, y in zip(a, b, strict=True)]
    assert ints(SUBTRACT(whole(a), whole(b))) == [(x - y) % ALL for x, y in zip(a, b, strict=True)]


@FEW
@given(counts, words, st.lists(st.booleans(), min_size=8, max_size=8))
def test_an_ordinary_array_can_be_added(a: list[int], b: list[int], c: list[bool]) -> None:
    assert ints(PLUS(whole(a), uint32(b))) == [(x + y) % ALL for x, y in zip(a, b, strict=True)]
    assert ints(PLUS(whole(a), np.array(c))) == [(x + y) % ALL for x, y in zip(a, c, strict=True)]
    small = [n >> 1 for n in b]
    as_int = np.array(small, np.int32)
    assert ints(PLUS(whole(a), as_int)) == [(x + y) % ALL for x, y in zip(a, small, strict=True)]


@FEW
@given(counts, counts, st.integers(0, 7))
def test_comparisons_are_those_of_integers(a: list[int], b: list[int], same: int) -> None:
    b[same] = a[same]
    b[same - 1] = a[same - 1] ^ (1 << 32)
    pairs = list(zip(a, b, strict=True))
    at_least, equal, chosen = compared(whole(a), whole(b))
    assert at_least.tolist() == [x >= y for x, y in pairs]
    assert equal.tolist() == [x == y for x, y in pairs]
    assert ints(chosen) == [max(x, y) for x, y in pairs]


@FEW
@given(counts, words, counts)
def test_ticks_until_a_later_tick_are_counted(
    a: list[int], gaps: list[int], far: list[int]
) -> None:
    def expected(now: int, then: int) -> int:
        return min(then - now, 2**31 - 1) if then > now else 2**31 - 1

    for later in ([(n + gap) % ALL for n, gap in zip(a, gaps, strict=True)], far, a):
        answer = UNTIL(whole(a), whole(later))
        assert answer.dtype == jnp.int32
        assert answer.tolist() == [expected(n, t) for n, t in zip(a, later, strict=True)]


@FEW
@given(words, words)
def test_products_keep_every_bit(a: list[int], b: list[int]) -> None:
    assert ints(TIMES(uint32(a), uint32(b))) == [x * y for x, y in zip(a, b, strict=True)]


@FEW
@given(counts)
def test_remainders_are_those_of_integers(a: list[int]) -> None:
    """The divisors that the law uses are at most 2^16."""
    for n in (1000, 2**16):
        answer = MODULO(whole(a), n)
        assert answer.dtype == jnp.int32
        assert answer.tolist() == [x % n for x in a]


@FEW
@given(counts)
def test_totals_and_largest_numbers_are_taken_along_either_axis(a: list[int]) -> None:
    grid = [a[:4], a[4:]]
    value = Wide(*(np.asarray(word).reshape(2, 4) for word in whole(a)))
    assert ints(TOTAL(value, 1)) == [sum(row) % ALL for row in grid]
    assert ints(TOTAL(value, 0)) == [sum(column) % ALL for column in zip(*grid, strict=True)]
    assert ints(LARGEST(value, 1)) == [max(row) for row in grid]
    assert ints(LARGEST(value, 0)) == [max(column) for column in zip(*grid, strict=True)]


@FEW
@given(st.lists(st.integers(-(2**31), 2**31 - 1), min_size=8, max_size=8))
def test_negative_words_keep_their_sign(a: list[int]) -> None:
    assert ints(SIGNED(np.array(a, np.int32))) == [n % ALL for n in a]


@FEW
@given(st.lists(st.integers(0, 2**63 - 1), min_size=8, max_size=8), st.integers(0, 62))
def test_a_count_becomes_a_float_of_full_precision(a: list[int], bits: int) -> None:
    a = [n >> bits for n in a]
    value = TO_FLOAT(whole(a))
    assert value.dtype == jnp.float32
    np.testing.assert_allclose(np.asarray(value, np.float64), a, rtol=2.0**-23)


def test_a_negative_number_becomes_a_float_within_two_last_bits() -> None:
    values = [-1, -5, -1000, -(2**24), -(2**32) - 1, -(2**32), -(10**12), -(2**63)]
    approximate = np.asarray(TO_FLOAT(wide(np.array(values, np.int64))), np.float64)
    np.testing.assert_allclose(approximate, values, rtol=2.0**-22)


def test_never_is_no_tick_that_happens() -> None:
    assert ints(never((2,))) == [2**64 - 1] * 2
    assert ints(zero((2,))) == [0, 0]
    almost = [2**64 - 2, 2**64 - 1, 2**64 - 2**32, 2**32 - 1, 0]
    assert happened(whole(almost)).tolist() == [True, False, True, True, True]
