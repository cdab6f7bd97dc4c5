"""Unsigned 64-bit counts as (hi, lo) pairs of uint32: ticks, births and numbers of organisms.

JAX without its x64 flag has no 64-bit integers, and an int32 age overflows within hours. On the host a
count is an int or a uint64 array. A function without a shape in its docstring works elementwise.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax


class Wide(NamedTuple):
    """A count modulo 2^64, split in two uint32 arrays of one shape."""

    hi: Array
    lo: Array

    def __add__(self, other: "Wide") -> "Wide":  # type: ignore[override]
        lo = self.lo + other.lo
        return Wide(self.hi + other.hi + (lo < other.lo).astype(jnp.uint32), lo)

    def __sub__(self, other: "Wide") -> "Wide":
        borrow = (self.lo < other.lo).astype(jnp.uint32)
        return Wide(self.hi - other.hi - borrow, self.lo - other.lo)

    def map(self, change: Callable[[Array], Array]) -> "Wide":
        """Return both words rearranged in the same way."""
        return Wide(change(self.hi), change(self.lo))

    def take(self, index: Any) -> "Wide":
        """Return the counts at an index of the arrays."""
        return Wide(self.hi[index], self.lo[index])

    def plus(self, n: Array) -> "Wide":
        """Return the counts plus a bool or non-negative integer array."""
        n = n.astype(jnp.uint32)
        return self + Wide(jnp.zeros_like(n), n)

    def at_least(self, other: "Wide") -> Array:
        """Return whether self >= other."""
        return (self.hi > other.hi) | ((self.hi == other.hi) & (self.lo >= other.lo))

    def until(self, later: "Wide") -> Array:
        """Return the ticks from this tick to a later one, int32, at most 2^31 - 1.

        If `later` is this tick or an earlier one, the result is 2^31 - 1 too.
        """
        far = np.uint32(2**31 - 1)
        gap = later - self
        near = ~self.at_least(later) & (gap.hi == 0)
        return jnp.where(near, jnp.minimum(gap.lo, far), far).astype(jnp.int32)

    def equals(self, other: "Wide") -> Array:
        """Return whether self == other."""
        return (self.hi == other.hi) & (self.lo == other.lo)


def wide(values: object) -> Wide:
    """Return ints or integer arrays of the host as counts; negative numbers wrap (two's complement)."""
    whole = np.asarray(np.asarray(values, dtype=object) % 2**64).astype(np.uint64)
    words = whole >> np.uint64(32), whole & np.uint64(0xFFFFFFFF)
    return Wide(*(jax.device_put(word.astype(np.uint32)) for word in words))


def to_host(value: Wide) -> np.ndarray:
    """Return counts as a uint64 array on the host."""
    hi, lo = np.asarray(value.hi), np.asarray(value.lo)
    return (hi.astype(np.uint64) << np.uint64(32)) | lo


def select(condition: Array, yes: Wide, no: Wide) -> Wide:
    """Return `yes` where the condition is true, and `no` elsewhere."""
    return Wide(jnp.where(condition, yes.hi, no.hi), jnp.where(condition, yes.lo, no.lo))


def total(value: Wide, axis: int) -> Wide:
    """Return the sum along an axis, exact modulo 2^64."""
    zero = jnp.uint32(0)
    hi, lo = lax.reduce(
        tuple(value), (zero, zero), lambda a, b: tuple(Wide(*a) + Wide(*b)), (axis,)
    )
    return Wide(hi, lo)


def largest(value: Wide, axis: int) -> Wide:
    """Return the maximum along an axis."""
    hi = value.hi.max(axis, keepdims=True)
    lo = jnp.where(value.hi == hi, value.lo, jnp.uint32(0)).max(axis)
    return Wide(jnp.squeeze(hi, axis), lo)


def times(a: Array, b: Array) -> Wide:
    """Return the 64-bit product of two uint32 or non-negative int32 arrays."""
    a, b = a.astype(jnp.uint32), b.astype(jnp.uint32)
    half, mask = np.uint32(16), np.uint32(0xFFFF)
    low = (a & mask) * (b & mask)
    middle = (a >> half) * (b & mask) + (low >> half)
    cross = (a & mask) * (b >> half) + (middle & mask)
    return Wide((a >> half) * (b >> half) + (middle >> half) + (cross >> half), a * b)


def modulo(value: Wide, n: int) -> Array:
    """Return the remainder after division by n, int32; n is 1 to 2^16."""
    high = (value.hi % np.uint32(n)) * np.uint32(2**32 % n)
    return ((high + value.lo % np.uint32(n)) % np.uint32(n)).astype(jnp.int32)


def signed(value: Array) -> Wide:
    """Return an int32 array as 64 bits, sign-extended."""
    return Wide((value >> 31).astype(jnp.uint32), value.astype(jnp.uint32))


def zero(shape: tuple[int, ...], library: Any = jnp) -> Wide:
    """Return counts of zero; `library` makes the arrays, JAX's or NumPy."""
    return Wide(*(library.zeros(shape, np.uint32) for _ in range(2)))


def never(shape: tuple[int, ...], library: Any = jnp) -> Wide:
    """Return 2^64 - 1: a tick that never comes, or a number that stands for no organism."""
    return Wide(*(library.full(shape, np.uint32(2**32 - 1), np.uint32) for _ in range(2)))


def happened(value: Wide) -> Array:
    """Return whether a tick differs from `never`."""
    return (value.hi & value.lo) != np.uint32(2**32 - 1)


def to_float(value: Wide) -> Array:
    """Return counts as float32; they are read as signed numbers in two's complement.

    The product with 2^32 is exact, so only the sum rounds.
    """
    negative = value.hi >> np.uint32(31) == 1
    size = select(negative, zero(value.lo.shape) - value, value)
    magnitude = size.hi.astype(jnp.float32) * np.float32(2**32) + size.lo.astype(jnp.float32)
    return jnp.where(negative, -magnitude, magnitude)
