"""One organism by itself: where its life stands, what it does next, and what is known of ticks lived."""

from typing import NamedTuple

import numpy as np
from jax import Array

from primordia.brains.contract import Genome
from primordia.habitats.contract import Bodies
from primordia.law import life
from primordia.law.law import Law
from primordia.law.life import Thought, Vitals
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide


class Instant(NamedTuple):
    """Where a life stands; one organism, so the first axis of everything is 1."""

    memory: Array
    vitals: Vitals
    bodies: Bodies
    """its senses, where the body itself is in a habitat on the host"""


class Stretch(NamedTuple):
    """Some ticks of a life, one after another, first axis n."""

    tick: np.ndarray
    """int64: of the world, at its end"""
    senses: np.ndarray
    """float32 (n, S): perceived, and acted upon"""
    action: np.ndarray
    """int32 (n,) or float32 (n, A)"""
    bodies: Bodies
    """after the tick; in a habitat on the host, what is `seen` of them, None if it shows nothing"""
    energy: np.ndarray
    """int32 after the tick, fixed point; it has no meaning without a metabolism"""
    eaten: np.ndarray
    """int32, fixed point: food of the whole life"""
    cause: np.ndarray
    """int32: cause of death that brain, body or store gives in the tick, or -1"""


class Mind(NamedTuple):
    """What the actions of N organisms depend on, beside the law and their senses."""

    genome: Genome
    key: Wide
    """(N,), of everything random in a life, such as its world's seed"""
    cell: Array
    """int32 (N,), within its world"""


def think(law: Law, mind: Mind, memory: Array, senses: Array, tick: Wide) -> Thought:
    """Think one tick, Wide (1,), with memory (N, M) and senses (N, S)."""
    key = stream(mind.key, Purpose.MOTOR, tick)
    return life.think(law, mind.genome, memory, senses, key, mind.cell)
