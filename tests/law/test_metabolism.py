"""Energy in fixed point, compared with exact arithmetic in Python."""

import math
from fractions import Fraction

import jax
import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from primordia.law.metabolism import (
    MOST,
    ONE,
    Rates,
    break_even,
    metabolise,
)

METABOLISE = jax.jit(metabolise)


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


TIES = [steps / 2 / ONE for steps in (1, 3, 5, -1, -3, 7, 0, 9)]
NONE, ALL = [0.0] * 8, [1.0] * 8


@example([0] * 8, TIES, NONE, NONE, ALL, NONE, [1e6] * 8)
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

    rates = Rates(*np.array([cap, drain, gain, cost, cap], np.float32))
    eaten_exerted = np.array([food, effort], np.float32)
    after = METABOLISE(np.array(energy, np.int32), *eaten_exerted, rates).tolist()
    for i in range(8):
        with np.errstate(over="ignore"):
            eaten = float(np.float32(gain[i]) * np.float32(food[i]))
            exerted = float(np.float32(cost[i]) * np.float32(effort[i]))
        change = kept(kept(-exact(float(np.float32(drain[i]))) - exact(exerted)) + exact(eaten))
        expected = min(kept(energy[i] + change), exact(float(np.float32(cap[i]))))
        assert after[i] == expected
        assert abs(after[i]) <= MOST


def test_break_even_is_the_food_that_pays_for_the_drain() -> None:
    """It is 0 without a drain, and None without a gain."""
    assert break_even(3.0, 2.0) == 1.5
    assert break_even(0.0, 2.0) == 0
    assert break_even(3.0, 0.0) is break_even(0.0, 0.0) is None
