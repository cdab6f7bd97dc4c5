"""The state of a single life at one instant, and the record of a stretch of its ticks."""

from typing import NamedTuple

import jax
import numpy as np
from jax import Array

from primordia.habitats.contract import Bodies
from primordia.law.life import Vitals


class Instant(NamedTuple):
    """The state of one life at the end of a tick; the first axis of every array is 1."""

    memory: Array
    vitals: Vitals
    bodies: Bodies
    """the body; or the senses, if the habitat is on the host, since such a habitat holds the body
    itself"""


class Stretch(NamedTuple):
    """n successive ticks of a life, first axis n."""

    tick: np.ndarray
    """int64: the world's tick"""
    senses: np.ndarray
    """float32 (n, S): senses on which the organism acted"""
    action: np.ndarray
    """int32 (n,) or float32 (n, A)"""
    bodies: Bodies
    """bodies after the tick; for a habitat on the host, the result of `seen`, or None"""
    energy: np.ndarray
    """int32, energy after the tick, fixed point; it has no meaning without a metabolism"""
    eaten: np.ndarray
    """int32, fixed point: food since birth"""
    cause: np.ndarray
    """int32: cause of death in the tick (from brain, body, energy or accident), or -1"""
    counts: np.ndarray
    """int32 (n, K): the habitat's counts after the tick"""

    def take(self, ticks: slice) -> "Stretch":
        """Return some of the ticks."""
        return jax.tree.map(lambda column: column[ticks], self)
