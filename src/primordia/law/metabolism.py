"""Metabolism: all energy arithmetic.

Energy is fixed point, int32 in steps of 1/1024 unit, and saturates. In float32, an energy of 2^25
would not change when 1 is subtracted, and the organism would never starve.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array
from pydantic import Field

from primordia.settings.base import Rate, Settings

ONE = 1024
"""Fixed-point steps in one unit of energy or food."""
MOST = 2**30 - 64
"""Largest energy or change, in steps; it is 1,048,575.9 units. It is exact in float32, and the sum of two
such energies fits in int32."""


class Metabolism(Settings):
    """The cost of living and the gain from food; an organism starves when its energy reaches 0.

    Schmidgall & Hays 2021, "Foraging". Each tick: energy - drain - effort_cost x effort + gain x
    food, at most cap x capacity, where food, effort and capacity are the habitat's.
    """

    store: Rate = Field(100.0, gt=0, le=1e6, description="energy at birth")
    drain: Rate = Field(1.0, ge=0, le=1e6, description="energy spent by living for one tick")
    gain: Rate = Field(1.0, ge=0, le=1e6, description="energy from one unit of food")
    effort_cost: Rate = Field(0.0, ge=0, le=1e6, description="energy spent on one unit of effort")
    cap: Rate = Field(1e6, gt=0, le=1e6, description="largest energy of an organism")


def to_fixed_point(value: Array) -> Array:
    """Return float32 numbers as fixed point int32, rounded to the nearest step and saturating, in NumPy
    or JAX like the input."""
    steps = (value * np.float32(ONE)).round().clip(-np.float32(MOST), np.float32(MOST))
    return steps.astype(np.int32)


def food_eaten(food: Array) -> Array:
    """Return food, float32, in fixed point, int32; where it is not finite, nothing was eaten."""
    return to_fixed_point(jnp.where(jnp.isfinite(food), food, 0.0))


def add(a: Array, b: Array) -> Array:
    """Return a + b in fixed point, clipped to +-MOST."""
    return jnp.clip(a + b, -MOST, MOST)


def break_even(drain: float, gain: float) -> float | None:
    """Return the food in a tick that keeps energy constant without effort; None if no amount does."""
    return drain / gain if gain > 0 else None


class Rates(NamedTuple):
    """The present prices and gains of each organism: float32, (N,) or broadcast to it."""

    store: Array
    drain: Array
    gain: Array
    effort_cost: Array
    cap: Array
    price: Array | None = None
    """energy that a try to copy costs; None unless replication is an act"""

    @classmethod
    def of(cls, climate: Mapping[str, Any]) -> "Rates":
        """Return these settings in a climate."""
        own = (climate[f"metabolism.{name}"] for name in Metabolism.model_fields)
        return cls._make([*own, climate.get("replication.price")])


def metabolise(
    energy: Array,
    food: Array | None,
    effort: Array | None,
    rates: Rates,
    capacity: Array | None = None,
) -> Array:
    """Return the energy of organisms after one tick, int32 (N,); an organism starves at 0 or less.

    `Outcome` describes food, effort and capacity.
    """
    change = -to_fixed_point(rates.drain)
    if effort is not None:
        change = add(change, -to_fixed_point(rates.effort_cost * effort))
    if food is not None:
        change = add(change, to_fixed_point(rates.gain * food))
    cap = rates.cap if capacity is None else rates.cap * capacity
    return jnp.minimum(add(energy, change), to_fixed_point(cap))
