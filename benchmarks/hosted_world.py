"""A world of a task on the host, in memory, kept full, timed, and taken apart by what its ticks cost."""

import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import jax

from primordia.config import load
from primordia.engine.engine import Engine
from primordia.random.wide import to_host
from worlds import organism_ticks

SETTINGS: dict[str, Any] = {
    "genesis": "fill",
    "hazard": 0.001,
    "replication": 0.5,
    "placement": {"topology": "well-mixed", "rule": "empty-only"},
    "stop": {"until": "none", "ticks": "none"},
}
"""Accidents at a stated rate, and cells filled again at once: births go on for ever."""
WARM = 2.5
"""seconds until chunks have come to their length"""


class Stopwatch:
    """Seconds spent in each part, less those in parts that it calls; what is in none is the rest."""

    def __init__(self) -> None:
        self.spent: defaultdict[str, float] = defaultdict(float)
        self._inside, self._since = ["rest"], time.perf_counter()

    def of(self, part: str, function: Callable) -> Callable:
        """The function, timed until what it returns has been computed."""

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
        """Of all the time so far."""
        self._turn()
        whole = sum(self.spent.values())
        return {part: seconds / whole for part, seconds in self.spent.items()}

    def _turn(self) -> None:
        """The time since the last turn was spent where we are."""
        now = time.perf_counter()
        self.spent[self._inside[-1]] += now - self._since
        self._since = now


class Ours:
    """An engine that is told to play, as the others of `contender.py` are."""

    about = ""

    def __init__(self, task: str, cells: int, settings: dict[str, Any]) -> None:
        """Settings of the task under which nobody dies but by accident."""
        self._engine = Engine(load(task, {**SETTINGS, **settings, "cells": cells}))
        self._limits = self._engine.limits({})
        self.play(WARM)

    def play(self, seconds: float) -> dict[str, float]:
        """Frames of living cells, births and ticks in about so many seconds."""
        before, began = self._counts(), time.perf_counter()
        self._advance(seconds)
        spent = time.perf_counter() - began
        lived = {name: count - before[name] for name, count in self._counts().items()}
        return {**lived, "seconds": spent}

    def budget(self, seconds: float) -> dict[str, Any]:
        """Microseconds a tick, and the shares of its parts; the stopwatch costs some of them."""
        before = self._counts()
        with ExitStack() as wrapped:
            watch = Stopwatch()
            for part, owner, names in self._parts():
                for name in names:
                    timed = watch.of(part, getattr(owner, name))
                    wrapped.enter_context(_replaced(owner, name, timed))
            self._advance(seconds)
            shares = watch.shares()
        ticks = self._counts()["ticks"] - before["ticks"]
        tick = 1e6 * sum(watch.spent.values()) / ticks
        return {"us a tick": tick, "shares": shares}

    def again(self, seconds: float) -> dict[str, float]:
        """So many seconds of robots' lives, and how long the batch alone takes for the same bodies under
        the same controls, where nobody is born: brains move bodies otherwise than chance does.
        """
        habitat: Any = self._engine.chunks._habitat
        bodies, begun, controls = habitat._bodies, habitat.save(), []
        step = bodies.step

        def kept(*who: Any, **how: Any) -> None:
            controls.append(bodies.ctrl.copy())
            step(*who, **how)

        with _replaced(bodies, "step", kept):
            spent = self.play(seconds)["seconds"]
        ended = habitat.save()
        habitat.load(begun)
        began = time.perf_counter()
        for each in controls:
            bodies.ctrl[:] = each
            step(nstep=habitat.substeps)
        alone = time.perf_counter() - began
        habitat.load(ended)
        return {"seconds": spent, "alone": alone}

    def _parts(self) -> list[tuple[str, Any, tuple[str, ...]]]:
        """What is timed: name of the part, whose methods, which."""
        law: Any = self._engine.chunks
        habitat = law._habitat
        simulator = habitat._pool if hasattr(habitat, "_pool") else habitat._bodies
        newborn = ("reset", "forward") if hasattr(simulator, "forward") else ("reset",)
        return [
            ("law and brains, compiled", law._calls, ("think", "live", "settle", "survey")),
            ("habitat, NumPy", habitat, ("step", "reset")),
            ("simulation", simulator, ("step",)),
            ("simulators of the newborn", simulator, newborn),
        ]

    def _advance(self, seconds: float) -> None:
        began = time.perf_counter()
        while time.perf_counter() - began < seconds:
            self._engine.advance(self._limits)
        jax.block_until_ready(self._engine.state)

    def _counts(self) -> dict[str, int]:
        """So far."""
        worlds = self._engine.state.world.worlds
        born, ticks = int(to_host(worlds.births).sum()), int(to_host(worlds.tick).sum())
        return {"frames": organism_ticks(self._engine), "births": born, "ticks": ticks}


@contextmanager
def _replaced(owner: Any, name: str, function: Callable) -> Iterator[None]:
    """Another function in a method's place for a while, in this object only, frozen or not."""
    held, before = name in vars(owner), getattr(owner, name)
    object.__setattr__(owner, name, function)
    try:
        yield
    finally:
        if held:
            object.__setattr__(owner, name, before)
        else:
            object.__delattr__(owner, name)
