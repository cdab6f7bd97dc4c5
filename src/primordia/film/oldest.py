"""Which organism is the oldest so far, at each moment of a world."""

import numpy as np

from primordia.phylogeny.living import stops
from primordia.runs.lives import Lives


def oldest_so_far(lives: Lives, ticks: np.ndarray) -> np.ndarray:
    """Return the row of the organism that has lived longest by each tick, dead or alive, int64 (F,).

    Args:
        lives: the lives of one world.
        ticks: int64 (F,), none before the first birth.
    """
    ends = stops(lives)
    # The first in the order of birth that still lives is the oldest of the living.
    living = np.searchsorted(np.maximum.accumulate(ends), ticks, side="right")
    living = np.minimum(living, len(lives) - 1)
    dead = np.flatnonzero(lives.died)
    dead = dead[np.argsort(lives.ended[dead], kind="stable")]
    longest = np.maximum.accumulate(np.append(0, lives.lifespan[dead]))
    by_then = np.searchsorted(lives.ended[dead], ticks, side="right")
    record = longest[by_then]
    holder = _holders(lives.lifespan[dead])[by_then]
    age = np.where(ends[living] > ticks, ticks - lives.born[living], -1)
    return np.where(age >= record, living, np.append(-1, dead)[holder])


def _holders(spans: np.ndarray) -> np.ndarray:
    """Return, for k = 0, 1, ..., 1 + the index of the longest of the first k spans; 0 for k = 0.

    Among equal spans the first counts."""
    longest = np.maximum.accumulate(np.append(-1, spans))
    new = np.append(False, spans > longest[:-1])
    return np.maximum.accumulate(np.where(new, np.arange(len(new)), 0))


def shown(holders: np.ndarray, least: int) -> np.ndarray:
    """Return the organism that is shown at each moment, (F,). Each stays for a while; see `least`.

    Args:
        holders: the oldest so far at each moment, (F,).
        least: smallest number of moments for which an organism is shown; only then may an older one
            take its place.
    """
    chosen, since = holders.copy(), 0
    for now in range(1, len(holders)):
        if holders[now] != chosen[now - 1] and now - since >= least:
            since = now
        else:
            chosen[now] = chosen[now - 1]
    return chosen
