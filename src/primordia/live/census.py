"""Counts of a run at the end of a chunk, and the speed of the run."""

from collections import deque
from dataclasses import dataclass

import jax
import numpy as np

from primordia.engine.state import Limits
from primordia.law.world import World
from primordia.random.wide import Wide, to_host
from primordia.settings.islands import Islands


@dataclass(frozen=True)
class Census:
    """Counts of W worlds, int64 (W,) unless another shape is given."""

    tick: np.ndarray
    alive: np.ndarray
    births: np.ndarray
    deaths: np.ndarray
    """(W, causes)"""
    extinctions: np.ndarray
    organism_ticks: np.ndarray
    calm: np.ndarray
    """ticks since the last birth or death"""
    saturated: np.ndarray
    """tick at which the world first was saturated, or -1"""
    mean_age: float
    """mean age of the living of all worlds, in ticks; 0 if none live"""
    oldest: int
    """age of the oldest organism of all worlds, in ticks; 0 if none live"""
    by_island: np.ndarray | None = None
    """living of each island, in all worlds together, int64 (K,); None without islands"""

    @classmethod
    def of(cls, world: World, alone: int | None = None, islands: Islands | None = None) -> "Census":
        """Count the organisms of all worlds, or of one (`alone`); every cell is read once.

        `islands` are those of each world; the living of each island are counted if there are several.
        """
        organisms, worlds = world
        cells, own = len(organisms.alive) // len(worlds.calm), slice(None)
        if alone is not None:
            worlds = jax.tree.map(lambda leaf: np.asarray(leaf)[alone : alone + 1], worlds)
            own = slice(alone * cells, (alone + 1) * cells)
        alive, tick = np.asarray(organisms.alive)[own], _count(worlds.tick)
        living = np.flatnonzero(alive)
        high, low = (np.asarray(words)[own][living].astype(np.int64) for words in organisms.born)
        ages = tick[living // cells] - (high << 32 | low)
        by_island = None
        if islands is not None and islands.count > 1:
            by_island = np.bincount(islands.of_cells(living % cells), minlength=islands.count)
        return cls(
            tick=tick,
            alive=np.count_nonzero(alive.reshape(len(tick), -1), axis=1),
            births=_count(worlds.births),
            deaths=_count(worlds.deaths),
            extinctions=_count(worlds.extinctions),
            organism_ticks=_count(worlds.organism_ticks),
            calm=np.asarray(worlds.calm).astype(np.int64),
            saturated=_count(worlds.saturated),
            mean_age=float(ages.mean()) if len(ages) else 0.0,
            oldest=int(ages.max(initial=0)),
            by_island=by_island,
        )


class Speed:
    """The speed of a run over the last seconds, measured between two censuses."""

    WINDOW = 2.0
    """least number of seconds between the two censuses"""

    def __init__(self) -> None:
        self._censuses: deque[tuple[float, Census]] = deque()

    def add(self, now: float, census: Census) -> None:
        """Add a census and the time, in seconds, at which it was taken."""
        self._censuses.append((now, census))
        while len(self._censuses) > 2 and now - self._censuses[1][0] >= self.WINDOW:
            self._censuses.popleft()

    def organism_ticks_per_s(self) -> float | None:
        """Return the organism-ticks per second of all worlds; None before there are two censuses."""
        if len(self._censuses) < 2:
            return None
        (then, before), (now, after) = self._censuses[0], self._censuses[-1]
        return float((after.organism_ticks - before.organism_ticks).sum()) / (now - then)

    def ticks_per_s(self) -> float | None:
        """Return the ticks per second of the fastest world; None before there are two censuses."""
        if len(self._censuses) < 2:
            return None
        (then, before), (now, after) = self._censuses[0], self._censuses[-1]
        return float((after.tick - before.tick).max()) / (now - then)

    def seconds_left(self, limits: Limits) -> float | None:
        """Return the seconds until the last world reaches a limit on ticks or births; None if unknown.

        A world that stops at saturation may stop sooner.
        """
        if len(self._censuses) < 2:
            return None
        (then, before), (now, after) = self._censuses[0], self._censuses[-1]
        seconds = now - then
        by_ticks = _needed(before.tick, after.tick, limits.ticks, seconds)
        by_births = _needed(before.births, after.births, limits.births, seconds)
        soonest = np.minimum(by_ticks, by_births)
        if bool(limits.saturation):
            soonest[after.saturated >= 0] = 0.0
        last = float(soonest.max())
        return last if np.isfinite(last) else None


def _needed(before: np.ndarray, after: np.ndarray, limit: Wide, seconds: float) -> np.ndarray:
    """Return the seconds that each world needs to reach a limit at its present speed, float64 (W,).

    Counts went from `before` to `after` in the given seconds. Without a limit the time is infinite.
    """
    ends = to_host(limit)
    to_go = np.maximum(ends.astype(float) - after, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        needed = np.where(to_go == 0, 0.0, to_go * seconds / (after - before))
    return np.where(ends == np.uint64(2**64 - 1), np.inf, needed)


def _count(value: Wide) -> np.ndarray:
    """Return a Wide as int64, with -1 in place of `wide.never`."""
    return to_host(value).astype(np.int64)
