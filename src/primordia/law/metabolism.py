"""Metabolism: the only energy arithmetic there is.

Energy is fixed point, int32 in units of 1/1024, and saturates. In float32 a store of 2^24 would
stop draining, and its owner seem immortal.
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
"""Largest store or change in steps, 1,048,575.9 units: exact in float32, and two add in 32 bits."""


class Metabolism(Settings):
    """What living costs and what food gives; an organism starves when its energy reaches 0.

    Schmidgall & Hays 2021, "Foraging". Each tick: energy - drain - effort_cost x effort + gain x
    food, at most cap.
    """

    store: Rate = Field(100.0, gt=0, le=1e6, description="energy at birth")
    drain: Rate = Field(1.0, ge=0, le=1e6, description="energy spent by living for one tick")
    gain: Rate = Field(1.0, ge=0, le=1e6, description="energy from one unit of food")
    effort_cost: Rate = Field(0.0, ge=0, le=1e6, description="energy spent on one unit of effort")
    cap: Rate = Field(1e6, gt=0, le=1e6, description="energy an organism can hold")


def fixed(value: Array) -> Array:
    """To fixed point, rounded to the nearest step and saturating: float32 -> int32."""
    steps = jnp.clip(jnp.round(value * np.float32(ONE)), -np.float32(MOST), np.float32(MOST))
    return steps.astype(jnp.int32)


def add(a: Array, b: Array) -> Array:
    """a + b in fixed point, kept within +-MOST."""
    return jnp.clip(a + b, -MOST, MOST)


def break_even(drain: float, gain: float) -> float | None:
    """Food a tick that keeps energy where it is, without effort; None where no food does."""
    return drain / gain if gain > 0 else None


class Rates(NamedTuple):
    """The settings above as they stand in each organism's world: float32, (N,) or broadcast to it."""

    store: Array
    drain: Array
    gain: Array
    effort_cost: Array
    cap: Array

    @classmethod
    def of(cls, climate: Mapping[str, Any]) -> "Rates":
        """Return those of a climate, whose names begin with `metabolism.`."""
        return cls(*(climate[f"metabolism.{name}"] for name in cls._fields))


def metabolise(energy: Array, food: Array | None, effort: Array | None, rates: Rates) -> Array:
    """One tick of every organism's energy, int32 (N,), before death by starvation is judged."""
    change = -fixed(rates.drain)
    if effort is not None:
        change = add(change, -fixed(rates.effort_cost * effort))
    if food is not None:
        change = add(change, fixed(rates.gain * food))
    return jnp.minimum(add(energy, change), fixed(rates.cap))
