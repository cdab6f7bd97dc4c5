"""Counter-based random bits: each bit is a pure function of seed, tick, purpose and cell.

The key of a draw is made of the world's seed, the tick and a named purpose; its counter is the cell.
Nothing else enters. So chunks, other worlds of the run, interruptions and the order of evaluation
change no bit. The cipher is Threefry-2x32 with 20 rounds (Salmon et al. 2011, "Parallel random
numbers: as easy as 1, 2, 3"), in uint32 arithmetic that is the same on every device. All functions
take and return arrays of shapes that broadcast.
"""

from dataclasses import dataclass, field
from enum import IntEnum
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from jax.tree_util import register_dataclass

from primordia.random.wide import Wide, times, zero

ROTATIONS = ((13, 15, 26, 6), (17, 29, 16, 24))
PARITY = 0x1BD11BDA


class Purpose(IntEnum):
    """The purpose of a stream of bits. Numbers are part of the format: never reuse or change one."""

    REPLICATE = 1
    HAZARD = 2
    PLACE = 3
    MUTATE = 4
    NOISE = 5
    FOUNDER = 6
    GENESIS = 7
    BODY = 8
    MOTOR = 9
    EVALUATION = 10
    SHADOW = 11
    REBIRTH = 12
    CONTROL = 13
    MATE = 14
    CROSS = 15
    DRIFT = 16


def encrypt(key: Wide, counter: Wide) -> Wide:
    """Encrypt counters (two words each) under keys (two words each), in NumPy or in JAX."""
    k = (key.hi, key.lo, key.hi ^ key.lo ^ np.uint32(PARITY))
    a, b = counter.hi + k[0], counter.lo + k[1]
    for block in range(5):
        for turn in ROTATIONS[block % 2]:
            a = a + b
            b = (b << np.uint32(turn)) | (b >> np.uint32(32 - turn))
            b = b ^ a
        a = a + k[(block + 1) % 3]
        b = b + k[(block + 2) % 3] + np.uint32(block + 1)
    return Wide(a, b)


_compiled = jax.jit(encrypt)


def threefry(key: Wide, counter: Wide) -> Wide:
    """Return `encrypt`: NumPy arrays by NumPy outside of compiled code, where JAX would compile it for
    each shape."""
    traced = any(isinstance(word, jax.core.Tracer) for word in (*key, *counter))
    words: Any = partial(jnp.asarray if traced else np.asarray, dtype=np.uint32)
    if traced:
        return _compiled(key.map(words), counter.map(words))
    with np.errstate(over="ignore"):  # NumPy warns of single numbers that wrap, and not of arrays
        return encrypt(key.map(words), counter.map(words)).map(words)


@register_dataclass
@dataclass(frozen=True)
class Streams:
    """The keys of all draws for some purposes, in one tick of each world: `streams[purpose]`."""

    keys: Wide
    """(P, ...), one for each purpose"""
    purposes: tuple[Purpose, ...] = field(metadata={"static": True})

    def __getitem__(self, purpose: Purpose) -> Wide:
        """Return the key of a purpose, (...)."""
        return self.keys.take(self.purposes.index(purpose))

    def replaced(self, key: Wide, *purposes: Purpose) -> "Streams":
        """Return the streams, but with this key (...) for these purposes."""
        keys = [key if each in purposes else self[each] for each in self.purposes]
        return Streams(Wide(*map(jnp.stack, zip(*keys, strict=True))), self.purposes)

    def take(self, index: Any) -> "Streams":
        """Return the streams at an index of the arrays."""
        return Streams(self.keys.map(lambda words: words[:, index]), self.purposes)


def streams(seed: Wide, tick: Wide, *purposes: Purpose) -> Streams:
    """Return the streams of one tick of each world for several purposes.

    One call for all purposes compiles faster than one call for each. Call it outside the compiled loop or
    branch that draws with the streams: XLA stores keys that come from outside. If the call is
    inside, XLA derives the keys again for every cell (measured: 20 us a tick in 16 worlds of 32
    cells; optimisation barriers do not help).
    """
    tick_key = threefry(seed, tick)
    numbers = np.array(purposes, np.uint32).reshape(-1, *[1] * tick_key.lo.ndim)
    counter: Any = numbers, np.uint32(0)
    return Streams(threefry(tick_key, Wide(*counter)), purposes)


def stream(seed: Wide, purpose: Purpose, tick: Wide) -> Wide:
    """Return the key of all draws for one purpose; see `streams`."""
    return streams(seed, tick, purpose)[purpose]


def bits(stream: Wide, cell: Array, index: Array | int = 0) -> Wide:
    """Return two words for a cell; another `index` gives another draw of the same stream and cell."""
    counter: Any = cell, index
    return threefry(stream, Wide(*counter))


def bits_if(needed: Array, stream: Wide, cell: Array, index: Array | int = 0) -> Wide:
    """Return `bits` if they are `needed` (bool ()), else zeros.

    The branch makes XLA store the words. Without it, XLA draws them again at each use.
    """
    shape = jnp.broadcast_shapes(stream.hi.shape, jnp.shape(cell), jnp.shape(index))
    index = jnp.asarray(index, jnp.uint32)
    return lax.cond(needed, bits, lambda *_: zero(shape), stream, cell, index)


def chance(word: Array, probability: Array) -> Array:
    """Return True with a given probability (float32 in [0, 1]): a word is compared with p * 2^32."""
    probability = jnp.asarray(probability, jnp.float32)
    below_one = jnp.minimum(probability, np.float32(1 - 2**-24))
    threshold = (below_one * np.float32(2**32)).astype(jnp.uint32)
    return (word < threshold) | (probability >= 1)


def below(word: Array, n: Array | int) -> Array:
    """Return an integer in [0, n), int32: the high word of word * n (bias at most n / 2^32)."""
    return times(word, jnp.asarray(n, jnp.uint32)).hi.astype(jnp.int32)
