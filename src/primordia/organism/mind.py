"""A mind: all that determines an organism's actions, apart from the law and the senses."""

from collections.abc import Callable
from typing import Any, NamedTuple

from jax import Array

from primordia.brains.contract import Genome
from primordia.compiled import shared
from primordia.law import life
from primordia.law.law import Law
from primordia.law.life import Thought
from primordia.random.keys import Purpose, stream
from primordia.random.wide import Wide


class Mind(NamedTuple):
    """Genomes, keys and cells of N organisms."""

    genome: Genome
    key: Wide
    """(N,), key of everything random in a life, such as the seed of its world"""
    cell: Array
    """int32 (N,), within the world"""


def perceiver(law: Law) -> Callable[[Any, Any], Any]:
    """Return `law.perceived` for calls from code that is not compiled.

    It is compiled if it computes. Otherwise a share of energy has other bits for one organism than for
    many (see `rounding`).
    """
    return shared(type(law).perceived, law) if law.interoception else law.perceived


def think(law: Law, mind: Mind, memory: Array, senses: Array, tick: Wide) -> Thought:
    """Return thoughts from memory (N, M) and perceived senses (N, S) at one `tick`, a Wide (1,)."""
    key = stream(mind.key, Purpose.MOTOR, tick)
    return life.think(law, mind.genome, memory, senses, key, mind.cell)
