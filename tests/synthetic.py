"""Tables of invented lives: of one world, or of several."""

from typing import Any

import numpy as np
from hypothesis import strategies as st
from numpy.typing import ArrayLike

from primordia.law.world import Cause
from primordia.runs.lives import ALIVE, Lives, joined

LIFE = st.tuples(st.integers(0, 40), st.integers(0, 40), st.booleans())
LIVED = st.lists(LIFE, min_size=1, max_size=20)


def one_world(
    born: ArrayLike,
    ended: ArrayLike,
    died: ArrayLike,
    parent: ArrayLike | None = None,
    **changed: Any,
) -> Lives:
    """Return one world's lives; by default founders, each in a cell of its own.

    Args:
        born: tick of birth of each organism.
        ended: tick of death, or the last tick on record.
        died: whether it died.
        parent: row of its parent, or -1; None: none has a parent.
        changed: other columns.
    """
    ticks = np.asarray(born, np.int64)
    number = np.arange(len(ticks))
    columns: dict[str, Any] = {
        "world": np.zeros(len(ticks), np.int32),
        "id": number,
        "parent": np.full(len(ticks), -1) if parent is None else np.asarray(parent, np.int64),
        "cell": number.astype(np.int32),
        "birth_cause": np.zeros(len(ticks), np.int8),
        "born": ticks,
        "seen": ticks,
        "inherited": np.zeros(len(ticks), bool),
        "ended": np.asarray(ended, np.int64),
        "cause": np.where(died, Cause.FATAL, ALIVE).astype(np.int8),
    }
    return Lives(**columns | changed)


def world_of(lived: list[tuple[int, int, bool]], until: int = 90) -> Lives:
    """Return the lives of one world from (born, lifespan, died), without descent, one in each cell."""
    born, lifespan, died = map(np.array, zip(*sorted(lived), strict=True))
    return one_world(born, np.where(died, born + 1 + lifespan, until), died)


def alive(world: Lives, row: int, tick: int) -> bool:
    """Return whether the organism of a row is alive at the end of a tick."""
    return world.born[row] <= tick and not (world.died[row] and world.ended[row] <= tick)


def occupants(lives: Lives, tick: int) -> dict[int, int]:
    """Return cell -> row of the organisms of a world that are alive at the end of a tick."""
    rows = [row for row in range(len(lives)) if alive(lives, row, tick)]
    found = {int(lives.cell[row]): row for row in rows}
    assert len(found) == len(rows), "two organisms in a cell"
    return found


def surviving(lives: Lives, longest: int) -> list[float]:
    """Return the share that survives each age from 0 to `longest`, counted age by age."""
    shares = [1.0]
    for age in range(1, longest + 1):
        at_risk = ((lives.entered < age) & (age <= lives.lifespan)).sum()
        died = (lives.died & (lives.lifespan == age)).sum()
        shares.append(shares[-1] * (1 - died / max(at_risk, 1)))
    return shares


def worlds_of(*lived: list[tuple[int, int, bool]], until: int) -> Lives:
    """Return the lives of several worlds."""
    return joined([world_of(lives, until) for lives in lived], np.arange(len(lived)))
