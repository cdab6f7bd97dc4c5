"""Lives made up for tests."""

from dataclasses import fields

import numpy as np
from hypothesis import strategies as st

from primordia.law.world import Cause
from primordia.runs.lives import ALIVE, Lives

LIFE = st.tuples(st.integers(0, 40), st.integers(0, 40), st.booleans())
LIVED = st.lists(LIFE, min_size=1, max_size=20)


def world_of(lived: list[tuple[int, int, bool]], until: int = 90) -> Lives:
    """One world's lives from (born, lifespan, died), without descent; each in a cell of its own."""
    born, lifespan, died = map(np.array, zip(*sorted(lived), strict=True))
    number = np.arange(len(born))
    return Lives(
        world=np.zeros(len(born), np.int32),
        id=number,
        parent=np.full(len(born), -1),
        cell=number.astype(np.int32),
        birth_cause=np.zeros(len(born), np.int8),
        born=born,
        seen=born,
        ended=np.where(died, born + 1 + lifespan, until),
        cause=np.where(died, Cause.FATAL, ALIVE).astype(np.int8),
    )


def alive(world: Lives, row: int, tick: int) -> bool:
    return world.born[row] <= tick and not (world.died[row] and world.ended[row] <= tick)


def worlds_of(*lived: list[tuple[int, int, bool]], until: int) -> Lives:
    """Several worlds of such lives."""
    each = [world_of(one, until) for one in lived]
    columns = {
        field.name: np.concatenate([getattr(one, field.name) for one in each])
        for field in fields(Lives)
    }
    numbers = np.repeat(np.arange(len(each), dtype=np.int32), list(map(len, each)))
    return Lives(**{**columns, "world": numbers})
