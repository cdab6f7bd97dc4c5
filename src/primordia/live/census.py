"""How things stand in a run at the end of a chunk, in numbers for people."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from primordia.engine.state import Limits
from primordia.law.world import World
from primordia.random.wide import Wide, to_host


@dataclass(frozen=True)
class Census:
    """Counts of W worlds; int64, of each world where not said otherwise."""

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
    """tick at which the world first was, or -1"""
    mean_age: float
    """of all the living of all worlds, in ticks; 0 if nobody lives"""
    oldest: int

    @classmethod
    def of(cls, world: World) -> "Census":
        """Count: reads every cell once."""
        organisms, worlds = world
        alive = np.asarray(organisms.alive)
        cells, tick = np.flatnonzero(alive), _count(worlds.tick)
        high, low = (np.asarray(words)[cells].astype(np.int64) for words in organisms.born)
        ages = tick[cells // (len(alive) // len(tick))] - (high << 32 | low)
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
        )


class Pace:
    """How fast a run goes, over about the last seconds."""

    WINDOW = 2.0
    """seconds"""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, Census]] = deque()

    def see(self, now: float, census: Census) -> None:
        """Take note of how things stand at a time in seconds."""
        self._seen.append((now, census))
        while len(self._seen) > 2 and now - self._seen[1][0] >= self.WINDOW:
            self._seen.popleft()

    def organism_ticks(self) -> float | None:
        """Lived a second by all; None before the second look."""
        if len(self._seen) < 2:
            return None
        (then, before), (now, after) = self._seen[0], self._seen[-1]
        return float((after.organism_ticks - before.organism_ticks).sum()) / (now - then)

    def seconds_left(self, limits: Limits) -> float | None:
        """Until every world has come to a limit on ticks or births, at this pace; None if unknown.

        The last one to stop counts. A world that will be stopped by saturation may stop sooner.
        """
        if len(self._seen) < 2:
            return None
        (then, before), (now, after) = self._seen[0], self._seen[-1]
        soonest = np.full(len(after.tick), np.inf)
        for name in ("tick", "births"):
            limit = to_host(limits.ticks if name == "tick" else limits.births)
            have, had = getattr(after, name), getattr(before, name)
            to_go = np.maximum(limit.astype(float) - have, 0.0)
            with np.errstate(divide="ignore", invalid="ignore"):
                needed = np.where(to_go == 0, 0.0, to_go * (now - then) / (have - had))
            unlimited = limit == np.uint64(2**64 - 1)
            soonest = np.minimum(soonest, np.where(unlimited, np.inf, needed))
        if bool(limits.saturation):
            soonest[after.saturated >= 0] = 0.0
        last = float(soonest.max())
        return last if np.isfinite(last) else None


def _count(value: Wide) -> np.ndarray:
    """A Wide as int64; what is `wide.never` becomes -1."""
    return to_host(value).astype(np.int64)
