"""One organism by itself: where its life stands, what it does next, and what is known of ticks lived."""

from typing import NamedTuple

import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.habitats.contract import Bodies
from primordia.law.law import Law
from primordia.law.life import act
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide


class Instant(NamedTuple):
    """Where a life stands; one organism, so the first axis of everything is 1."""

    memory: Array
    energy: Array
    """int32, fixed point"""
    bodies: Bodies
    """its senses, where the body itself is in a habitat on the host"""


class Stretch(NamedTuple):
    """Some ticks of a life, one after another, first axis n."""

    tick: np.ndarray
    """int64: of the world, at its end"""
    senses: np.ndarray
    """float32 (n, S): perceived, and acted upon"""
    action: np.ndarray
    """int32 (n,) or float32 (n, A): what it did"""
    bodies: Bodies
    """as they then are; in a habitat on the host, what is `seen` of them, None if it shows nothing"""
    energy: np.ndarray
    """float64, units; it has no meaning without a metabolism"""
    fatal: np.ndarray
    """bool"""


class Mind(NamedTuple):
    """What an organism's actions are a function of, beside the law and what it perceives."""

    genome: Genome
    """of one"""
    seed: Wide
    """(1,), its world's"""
    cell: Array
    """int32 (1,), within its world"""


def think(law: Law, mind: Mind, memory: Array, senses: Array, tick: Wide) -> tuple[Array, Array]:
    """One tick, Wide (1,), of memory (1, M) and senses (1, S) -> memory, action."""
    memory, output = law.brain(mind.genome, memory, senses)
    return memory, act(law, stream(mind.seed, Purpose.MOTOR, tick), mind.cell, output)
