"""The moments that a film shows, at equal distances in births or in ticks."""

from typing import Literal, TypeAlias

import numpy as np

from primordia.errors import InputError
from primordia.runs.lives import Lives

By: TypeAlias = Literal["births", "ticks"]
RATE = 30
"""pictures in a second"""
SECONDS = 30
"""length of a film, at most"""


def moments(lives: Lives, start: int, by: By, ticks: tuple[int | None, int | None]) -> np.ndarray:
    """Return the ticks after which a world is shown, in ascending order, int64 (F,).

    Args:
        lives: the lives of one world.
        start: the tick at which the world's records begin.
        by: `births` or `ticks`: the same number of them passes between one moment and the next. In a full
            world most ticks are without births.
        ticks: the first tick and the last one; None: where the records begin or end.

    Raises:
        InputError: the records have no such ticks, or nothing was born in them.
    """
    first, last = start, int(lives.ended.max())
    begin, end = (
        given if given is not None else own for given, own in zip(ticks, (first, last), strict=True)
    )
    if not first <= begin < end <= last:
        raise InputError(
            f"the world can be shown from tick {first} to {last}, not from {begin} to {end}"
        )
    if by == "ticks":
        return np.unique(np.linspace(begin, end, RATE * SECONDS).astype(np.int64))
    born = lives.born[(lives.born > begin) & (lives.born <= end)]
    if not len(born):
        raise InputError(
            f"nothing was born from tick {begin} to {end}; choose other ticks, or --by ticks"
        )
    chosen = np.linspace(0, len(born) - 1, RATE * SECONDS).astype(np.int64)
    return np.unique([begin, *born[chosen], end])
