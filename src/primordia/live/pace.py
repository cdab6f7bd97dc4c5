"""The pace of a run that is watched: limited speed, pauses, and single steps.

No life depends on the pace, since the length of chunks and the time between them change nothing.
"""

import time
from collections.abc import Callable

import numpy as np

from primordia import interrupts
from primordia.random.wide import to_host
from primordia.runs.loop import Status

FRAME = 0.1
"""Seconds of a chunk at a limited speed."""
NAP = 0.25
"""Largest number of seconds until a waiting run notices a signal."""
LEVELS = [step * 10**power for power in range(9) for step in (1, 3)]
"""Speeds that can be chosen by key, in ticks a second."""
UNKNOWN = 10_000
"""Assumed speed of a run before its speed is known, in ticks a second."""


class Pace:
    """The limit of a run's speed, and whether it is paused."""

    def __init__(self, limit: float | None = None) -> None:
        """Set the limit, in ticks a second; None for no limit."""
        self.limit, self.paused = limit, False
        self._steps = 0
        self._ticks: np.ndarray | None = None
        self._lived, self._late = 0, False
        self._restart()

    def __str__(self) -> str:
        """Describe the pace in a few words; full speed needs none."""
        if self.paused:
            return "paused"
        return "" if self.limit is None else f"at most {self.limit:,g} ticks/s"

    def pause(self) -> None:
        """Pause, or go on."""
        self.paused, self._steps = not self.paused, 0
        self._restart()

    def step(self) -> None:
        """Live one tick, and pause."""
        self.paused, self._steps = True, self._steps + 1

    def slower(self, speed: float | None) -> None:
        """Lower the limit below the present `speed`, in ticks a second; None if the speed is unknown."""
        present = speed or UNKNOWN
        if self.limit is not None:
            present = min(self.limit, present) if self._late else self.limit
        self.limit = max((level for level in LEVELS if level < present), default=self.limit)
        self._restart()

    def faster(self) -> None:
        """Raise the limit, or remove it if the run is slower than its limit."""
        above = [level for level in LEVELS if self.limit is not None and level > self.limit]
        self.limit = above[0] if above and not self._late else None
        self._restart()

    def __call__(self, status: Status, react: Callable[[float], object] = time.sleep) -> None:
        """Wait until the next chunk may begin, and set its length.

        Args:
            status: the run.
            react: function that is called repeatedly; it waits for some seconds, and may change
                this pace.
        """
        if self.limited:
            self._note(to_host(status.engine.state.world.worlds.tick))
        while (left := self._wait()) > 0 and not interrupts.came():
            react(min(left, NAP))
        if self.paused:
            self._steps = max(self._steps - 1, 0)
            status.engine.longest = 1
        elif self.limit is not None:
            status.engine.longest = max(int(self.limit * FRAME), 1)
        else:
            status.engine.longest = None

    @property
    def limited(self) -> bool:
        """Whether the run is paused, or its speed is limited."""
        return self.paused or self.limit is not None

    def _wait(self) -> float:
        """Return the seconds until the next chunk may begin; 0 or less if it may begin now."""
        if self.paused:
            return 0.0 if self._steps else np.inf
        if self.limit is None:
            return 0.0
        return self._began + self._lived / self.limit - time.perf_counter()

    def _note(self, ticks: np.ndarray) -> None:
        """Take the ticks of all worlds; worlds that have stopped do not count."""
        if self._ticks is not None:
            self._lived += int((ticks - self._ticks).max())
        self._ticks = ticks
        self._late = self.limit is not None and not self.paused and self._wait() < -FRAME
        if self._late:  # a run that is slower than its limit does not catch up later
            self._began, self._lived = time.perf_counter(), 0

    def _restart(self) -> None:
        self._began, self._lived, self._late = time.perf_counter(), 0, False
        self._ticks = None
