"""Full worlds of a task on the host, with records: their speed, and the cost of each part of a tick."""

import time
from collections import defaultdict
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import jax

from primordia.config import load
from primordia.engine.engine import Engine
from primordia.random.wide import to_host
from primordia.runs.loop import recorder_for
from primordia.runs.schema import TABLES
from tapes import replaced, tape_of
from worlds import organism_ticks

SETTINGS: dict[str, Any] = {
    "genesis": "fill",
    "hazard": 0.001,
    "replication": 0.5,
    "placement": {"topology": "well-mixed", "rule": "empty-only"},
    "stop": {"until": "none", "ticks": "none"},
}
"""Accidents at a given rate. Empty cells are filled at once, so births never end."""
WARM = 2.5
"""seconds until chunks have reached their length"""


class Stopwatch:
    """Seconds spent in each part, without the parts that it calls; time in no part is `rest`."""

    def __init__(self) -> None:
        self.spent: defaultdict[str, float] = defaultdict(float)
        self._inside, self._since = ["rest"], time.perf_counter()

    def of(self, part: str, function: Callable) -> Callable:
        """Return the function, timed until its results have been computed."""

        def timed(*arguments: Any, **named: Any) -> Any:
            self._turn()
            self._inside.append(part)
            try:
                return jax.block_until_ready(function(*arguments, **named))
            finally:
                self._turn()
                self._inside.pop()

        return timed

    def shares(self) -> dict[str, float]:
        """Return the share of each part in the time so far."""
        self._turn()
        whole = sum(self.spent.values())
        return {part: seconds / whole for part, seconds in self.spent.items()}

    def _turn(self) -> None:
        """Count the time since the last turn for the part that is running."""
        now = time.perf_counter()
        self.spent[self._inside[-1]] += now - self._since
        self._since = now


class Ours:
    """Our engine as one way of playing of `contender.py`."""

    about = ""

    def __init__(self, task: str, cells: int, settings: dict[str, Any], worlds: int = 1) -> None:
        """Take settings of the task under which organisms die by accident only."""
        shape = {"cells": cells, "seeds": worlds}
        self._engine = Engine(load(task, {**SETTINGS, **settings, **shape}))
        self._limits = self._engine.limits({})
        self._folder = TemporaryDirectory()
        for table in TABLES:
            Path(self._folder.name, table).mkdir()
        self._recorder = recorder_for(self._engine, Path(self._folder.name))
        self.play(WARM)

    def play(self, seconds: float) -> dict[str, float]:
        """Play for about `seconds`.

        Returns:
            frames of living cells, births, ticks of all worlds, seconds; `cpu`: seconds of processor time
            of this process.
        """
        before, began, used = self._counts(), time.perf_counter(), time.process_time()
        self._advance(seconds)
        spent = {"seconds": time.perf_counter() - began, "cpu": time.process_time() - used}
        return {**spent, **{name: n - before[name] for name, n in self._counts().items()}}

    def budget(self, seconds: float) -> dict[str, Any]:
        """Return microseconds per tick and the shares of its parts; the stopwatch costs some time."""
        before = self._counts()
        with ExitStack() as wrapped:
            watch = Stopwatch()
            for part, owner, names in self._parts():
                for name in names:
                    timed = watch.of(part, getattr(owner, name))
                    wrapped.enter_context(replaced(owner, name, timed))
            self._advance(seconds)
            shares = watch.shares()
        ticks = self._counts()["ticks"] - before["ticks"]
        tick = 1e6 * sum(watch.spent.values()) / ticks
        return {"us a tick": tick, "shares": shares}

    def record(self, seconds: float) -> dict[str, float]:
        """Play, and keep what the simulators were told."""
        self._tape = tape_of(self._engine.chunks._habitat)
        return self._tape.record(lambda: self.play(seconds))

    def alone(self, seconds: float) -> dict[str, float]:
        """Step the simulators alone as in the recording, whatever `seconds`; return the seconds taken."""
        return self._tape.play_alone()

    def _parts(self) -> list[tuple[str, Any, tuple[str, ...]]]:
        """Return what is timed: the part's name, the object, and the names of its methods."""
        law: Any = self._engine.chunks
        habitat = law._habitat
        simulator = habitat._pool if hasattr(habitat, "_pool") else habitat._bodies.batch
        newborn = ("reset", "forward") if hasattr(simulator, "forward") else ("reset",)
        return [
            ("law and brains, compiled", law._calls, ("think", "live", "settle", "survey")),
            ("habitat, NumPy", habitat, ("step", "reset")),
            ("simulation", simulator, ("step",)),
            ("simulators of the newborn", simulator, newborn),
            ("records", self._recorder, ("append",)),
        ]

    def _advance(self, seconds: float) -> None:
        began = time.perf_counter()
        while time.perf_counter() - began < seconds:
            self._recorder.append(self._engine.advance(self._limits))
        jax.block_until_ready(self._engine.state)

    def _counts(self) -> dict[str, int]:
        """Return the frames, births and ticks so far."""
        worlds = self._engine.state.world.worlds
        born, ticks = int(to_host(worlds.births).sum()), int(to_host(worlds.tick).sum())
        return {"frames": organism_ticks(self._engine), "births": born, "ticks": ticks}
