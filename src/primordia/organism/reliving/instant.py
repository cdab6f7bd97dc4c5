"""The state of a single life at one instant, and the record of a stretch of its ticks."""

from typing import NamedTuple

import jax
import numpy as np
from jax import Array

from primordia.habitats.contract import Bodies, Outcome
from primordia.law.law import Law
from primordia.law.life import Thought, Vitals, judge, try_to_copy
from primordia.law.metabolism import Rates


class Instant(NamedTuple):
    """The state of one life at the end of a tick; the first axis of every array is 1."""

    memory: Array
    vitals: Vitals
    bodies: Bodies
    """the body; or the senses, if the habitat is on the host, since such a habitat holds the body
    itself"""


def judged(
    law: Law,
    now: Instant,
    thought: Thought,
    bodies: Bodies,
    outcome: Outcome,
    rates: Rates,
    given: Array,
) -> tuple[Instant, Array]:
    """Judge a tick of one life; see `life.judge`. Return the state after it, and the cause of death.

    If replication is an act, the organism also pays the price of its try, and `given`, int32 (1,): the
    endowment of the child born to it in the tick. It is the recorded one, since births depend on the
    neighbours.
    """
    vitals, cause = judge(law, now.vitals, thought.faulty, bodies, outcome, rates, thought.spent)
    if thought.copying is not None:
        vitals, _ = try_to_copy(law, vitals, cause, thought.copying, rates)
        vitals = vitals._replace(energy=vitals.energy - given)
    return Instant(thought.memory, vitals, bodies), cause


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
    """int32, energy after the tick and its birth, fixed point; it has no meaning without a metabolism"""
    eaten: np.ndarray
    """int32, fixed point: food since birth"""
    cause: np.ndarray
    """int32: cause of death in the tick (from brain, body, energy or accident), or -1"""
    counts: np.ndarray
    """int32 (n, K): the habitat's counts after the tick"""

    def take(self, ticks: slice) -> "Stretch":
        """Return some of the ticks."""
        return jax.tree.map(lambda column: column[ticks], self)
