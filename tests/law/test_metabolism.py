"""Energy in fixed point, compared with exact arithmetic in Python."""

import math
from fractions import Fraction

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from primordia.law.metabolism import (
    MOST,
    ONE,
    Metabolism,
    Rates,
    add,
    break_even,
    metabolise,
    to_fixed_point,
)

FIXED, METABOLISE = jax.jit(to_fixed_point), jax.jit(metabolise)
RATES = ("store", "drain", "gain", "effort_cost", "cap")


def exact(value: float) -> int:
    """Return the exact value of `fixed` for one float32."""
    if math.isinf(value):
        return MOST if value > 0 else -MOST
    return max(-MOST, min(MOST, round(Fraction(value) * ONE)))


def kept(steps: int) -> int:
    return max(-MOST, min(MOST, steps))


numbers = st.lists(
    st.one_of(
        st.floats(width=32, allow_nan=False),
        st.floats(-1000, 1000, width=32),
        st.integers(-(2**24), 2**24).map(lambda n: n / 2048),
        st.sampled_from([MOST / ONE, -MOST / ONE, 1e6, -1e6, math.inf, -math.inf, -0.0]),
    ),
    min_size=8,
    max_size=8,
)


@settings(max_examples=50)
@given(numbers)
def test_amounts_are_rounded_to_the_nearest_step_and_saturate(values: list[float]) -> None:
    steps = FIXED(jnp.array(values, jnp.float32))
    assert steps.dtype == jnp.int32
    assert steps.tolist() == [exact(float(np.float32(v))) for v in values]


def test_amounts_have_the_steps_computed_by_hand() -> None:
    halves = jnp.array([0.5, 1.5, 2.5, -0.5, -1.5], jnp.float32) / ONE
    assert to_fixed_point(halves).tolist() == [0, 2, 2, 0, -2]
    assert to_fixed_point(jnp.float32(100.5)) == 102_912
    assert MOST == 2**30 - 64
    assert to_fixed_point(jnp.float32(3e38)) == MOST


@settings(max_examples=40)
@given(*[st.lists(st.integers(-MOST, MOST), min_size=8, max_size=8)] * 2)
def test_sums_saturate_and_never_wrap(a: list[int], b: list[int]) -> None:
    sums = add(jnp.array(a, jnp.int32), jnp.array(b, jnp.int32))
    assert sums.tolist() == [kept(x + y) for x, y in zip(a, b, strict=True)]


rate = st.lists(
    st.one_of(st.floats(0, 1e6, width=32), st.sampled_from([0.0, 0.1, 1.0, 1e6])),
    min_size=8,
    max_size=8,
)
energies = st.lists(
    st.one_of(st.integers(-MOST, MOST), st.sampled_from([0, 1, MOST, -MOST])),
    min_size=8,
    max_size=8,
)


@settings(max_examples=50)
@given(energies, numbers, numbers, rate, rate, rate, rate)
def test_a_tick_changes_energy_as_exact_arithmetic_does(
    energy: list[int],
    food: list[float],
    effort: list[float],
    drain: list[float],
    gain: list[float],
    cost: list[float],
    cap: list[float],
) -> None:
    gain = [g if math.isfinite(f) else 1.0 for g, f in zip(gain, food, strict=True)]
    cost = [c if math.isfinite(e) else 1.0 for c, e in zip(cost, effort, strict=True)]

    def column(values: list[float]) -> jax.Array:
        return jnp.array(values, jnp.float32)

    rates = Rates(column(cap), column(drain), column(gain), column(cost), column(cap))
    args = jnp.array(energy, jnp.int32), column(food), column(effort), rates
    after = METABOLISE(*args)
    for i in range(8):
        with np.errstate(over="ignore"):
            eaten = float(np.float32(gain[i]) * np.float32(food[i]))
            exerted = float(np.float32(cost[i]) * np.float32(effort[i]))
        change = kept(kept(-exact(float(np.float32(drain[i]))) - exact(exerted)) + exact(eaten))
        expected = min(kept(energy[i] + change), exact(float(np.float32(cap[i]))))
        assert int(after[i]) == expected
        assert abs(int(after[i])) <= MOST


def test_food_and_effort_that_a_habitat_lacks_change_no_energy() -> None:
    rates = Rates(*(jnp.full(2, value, jnp.float32) for value in (9, 1, 2, 4, 1e6)))
    energy = jnp.array([10 * ONE, 20 * ONE], jnp.int32)
    some = jnp.array([0.5, 0.25], jnp.float32)
    assert metabolise(energy, None, None, rates).tolist() == [9 * ONE, 19 * ONE]
    assert metabolise(energy, some, None, rates).tolist() == [10 * ONE, 19 * ONE + ONE // 2]
    assert metabolise(energy, None, some, rates).tolist() == [7 * ONE, 18 * ONE]


def test_a_body_holds_its_share_of_the_cap() -> None:
    rates = Rates(*(jnp.full(3, value, jnp.float32) for value in (9, 1, 1, 1, 20)))
    energy, share = jnp.full(3, 16 * ONE, jnp.int32), jnp.array([0.5, 1, 2], jnp.float32)
    food = jnp.full(3, 100, jnp.float32)
    held = [10 * ONE, 20 * ONE, 40 * ONE]
    assert metabolise(energy, food, None, rates, share).tolist() == held
    assert metabolise(energy, None, None, rates, share).tolist() == [10 * ONE, 15 * ONE, 15 * ONE]


def test_a_store_is_drained_even_if_float32_could_not_show_it() -> None:
    rates = Rates(*(jnp.full(1, value, jnp.float32) for value in (1e6, 1 / 1024, 0, 0, 1e6)))
    energy = to_fixed_point(rates.store)
    before = int(energy[0])
    for _ in range(5):
        energy = METABOLISE(energy, None, None, rates)
    assert int(energy[0]) == before - 5


@pytest.mark.parametrize("name", RATES)
@pytest.mark.parametrize("value", [-1.0, -1e-9, 1.1e6, 2e6, math.nan, math.inf])
def test_rates_out_of_range_are_refused(name: str, value: float) -> None:
    with pytest.raises(ValidationError, match=rf"\n{name}\n"):
        Metabolism(**{name: value})


def test_rates_at_the_ends_of_their_range_are_accepted() -> None:
    """A store or a cap of 0 would starve every organism in its first tick."""
    for name in RATES:
        assert getattr(Metabolism(**{name: 1e6}), name) == 1e6
    for name in ("drain", "gain", "effort_cost"):
        assert getattr(Metabolism(**{name: 0.0}), name) == 0
    for name in ("store", "cap"):
        with pytest.raises(ValidationError, match=f"{name}\n.*greater than 0"):
            Metabolism(**{name: 0.0})


@pytest.mark.parametrize(
    ("drain", "gain", "food"),
    [(3.0, 2.0, 1.5), (0.0, 2.0, 0.0), (3.0, 0.0, None), (0.0, 0.0, None)],
)
def test_break_even_is_the_food_that_pays_for_the_drain(
    drain: float, gain: float, food: float | None
) -> None:
    """It is 0 without a drain, and None without a gain."""
    assert break_even(drain, gain) == food
