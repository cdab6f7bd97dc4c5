"""Lives to compare: their random words and actions are equal; neighbours, pauses or cells differ."""

import copy
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

import jax
import numpy as np
from PIL.Image import Image

from primordia.habitats.bodies import random_actions
from primordia.habitats.checks import check_outcome
from primordia.habitats.contract import (
    Ability,
    AnyHabitat,
    HostHabitat,
    JaxHabitat,
)
from primordia.habitats.on_host import OnHost
from primordia.random.trials import words
from primordia.settings.tracing import Tracing
from primordia.testing.report import ALL, ContractError, kept, need, typed

TICKS = 12
HALF = TICKS // 2

Past: TypeAlias = list[tuple[Any, ...]]
"""For each age from birth on: senses, outcome and tally; None for a value that is not reported."""


class Lives:
    """The lives of ALL bodies of a habitat. They must be the same however they are played."""

    def __init__(self, habitat: AnyHabitat) -> None:
        self.habitat = habitat
        self.words = words(0, ALL, habitat.words)
        self.actions = random_actions(habitat.action, TICKS, ALL)

    @contextmanager
    def opened(self, who: np.ndarray, cells: int, watched: bool = False) -> Iterator["Stage"]:
        """Open a copy of the habitat; its first cells are for the bodies `who`, in order."""
        inner = self.habitat
        own = OnHost(inner) if isinstance(inner, JaxHabitat) else copy.deepcopy(inner)
        try:
            own.open(cells, watched)
            yield Stage(self, own, who, cells)
        finally:
            own.close()

    def whole(self) -> list[Past]:
        """Play all lives side by side."""
        return self._played(np.arange(ALL))

    def among(self, count: int) -> list[Past]:
        """Play only the lives of the last `count` bodies, which lie in cells in reversed order."""
        return self._played(np.arange(ALL)[::-1][:count])

    def interrupted(self) -> list[Past]:
        """Play with a rest of three ticks for every second body."""
        with self.opened(np.arange(ALL), ALL) as stage:
            stage.bear()
            for tick in range(TICKS + 3):
                rests = (np.arange(ALL) % 2 == 0) & (3 <= tick < 6)
                stage.tick(~rests)
            return stage.pasts

    def born_late(self) -> list[Past]:
        """Play with every third body born a second time in the cell where it has lived for a while."""
        with self.opened(np.arange(ALL), ALL) as stage:
            stage.bear()
            for tick in range(TICKS):
                if tick == HALF:
                    stage.bear(np.arange(ALL) % 3 == 0)
                stage.tick()
            return stage.pasts

    def restored(self, rows: slice) -> list[Past]:
        """Play half of each life, then the rest of some lives in a habitat that loads the saved state."""
        with self.opened(np.arange(ALL), ALL) as stage:
            stage.play(HALF)
            saved = stage.saved()
        who = np.arange(ALL)[rows]
        with self.opened(who, len(who)) as stage2:
            stage2.take_over(stage, {name: array[rows].copy() for name, array in saved.items()})
            for _ in range(TICKS - HALF):
                stage2.tick()
            return stage2.pasts

    def drawn(self) -> None:
        """Check the pictures and the captions of one body."""
        with self.opened(np.arange(2), 2, watched=True) as stage:
            stage.play(1)
            body = jax.tree.map(lambda leaf: np.array(leaf)[1], stage.habitat.seen())
            action = self.actions[0, 1]
            picture = stage.habitat.picture(body, action)
            need(
                isinstance(picture, Image),
                self.habitat,
                f"returns {type(picture).__name__} from picture; return a PIL.Image.Image",
            )
            said = stage.habitat.caption(body, action)
            need(
                isinstance(said, str),
                self.habitat,
                f"returns {said!r} from caption; return a string",
            )

    def compare(self, expected: list[Past], found: list[Past], says: str) -> None:
        """Raise ContractError if a life differs from the expected one before the shorter of them ends."""
        for body, (one, other) in enumerate(zip(expected, found, strict=True)):
            for age, (a, b) in enumerate(zip(one, other, strict=False)):
                pairs = zip(a, b, strict=False)
                if any(np.asarray(x).tobytes() != np.asarray(y).tobytes() for x, y in pairs):
                    name = type(self.habitat).__name__
                    raise ContractError(
                        f"{name}: body {body} has a different life at age {age} {says}"
                    )

    def _played(self, who: np.ndarray) -> list[Past]:
        with self.opened(who, len(who)) as stage:
            stage.play(TICKS)
            return stage.pasts


class Stage:
    """Some of the lives in an opened habitat."""

    def __init__(self, lives: Lives, habitat: HostHabitat, who: np.ndarray, cells: int) -> None:
        self.lives, self.habitat, self.who, self.cells = lives, habitat, who, cells
        self.age, self.alive = np.zeros(cells, int), np.zeros(cells, bool)
        self.pasts: list[Past] = [[] for _ in range(ALL)]

    def bear(self, chosen: np.ndarray | None = None) -> None:
        """Begin the lives of the bodies in the `chosen` cells, bool (N,), or in all cells."""
        cells = np.flatnonzero(np.ones(self.cells, bool) if chosen is None else chosen)
        part, own = self.lives.habitat, self.who[cells]
        given = self.lives.words[own]
        senses = self.habitat.reset(cells, given.copy())
        typed(part, "senses from reset", senses, (len(cells), part.senses_size), np.float32)
        need(np.isfinite(senses).all(), part, "gives senses from reset that are not finite")
        for body, row in zip(own, np.array(senses), strict=True):
            self.pasts[body] = [(row,)]
        self.age[cells], self.alive[cells] = 0, True

    def tick(self, chosen: np.ndarray | None = None) -> None:
        """Step the bodies in all cells, or in the `chosen` cells, bool (N,), if they have ticks left."""
        part = self.lives.habitat
        active = self.alive & (self.age < TICKS)
        active &= True if chosen is None else chosen
        action = np.zeros((self.cells, *self.lives.actions.shape[2:]), self.lives.actions.dtype)
        action[active] = self.lives.actions[self.age[active], self.who[active]]
        senses, outcome = self.habitat.step(action.copy(), active.copy())
        typed(part, "senses from step", senses, (self.cells, part.senses_size), np.float32)
        with kept():
            check_outcome(Tracing("habitat", part), outcome, self.cells)
        told = [None if each is None else np.array(each) for each in (senses, *outcome)]
        told += [self._tally()] if part.can(Ability.TALLY) else []
        for cell in np.flatnonzero(active):
            row = tuple(None if each is None else each[cell] for each in told)
            self.pasts[self.who[cell]].append(row)
        self.age[active] += 1
        for ended in (outcome.fatal, outcome.fault, outcome.expired):
            if ended is not None:
                self.alive &= ~np.asarray(ended)
        living, given = active & self.alive, {"senses": senses, **outcome._asdict()}
        for name, each in given.items():
            finite = each is None or np.isfinite(np.asarray(each)[living]).all()
            need(
                finite, part, f"gives values of {name} that are not finite, for bodies that live on"
            )

    def play(self, ticks: int) -> None:
        """Begin all lives, and live some ticks."""
        self.bear()
        for _ in range(ticks):
            self.tick()

    def saved(self) -> dict[str, np.ndarray]:
        """Return the saved state of the habitat, checked."""
        part, arrays = self.lives.habitat, self.habitat.save()
        for name, array in arrays.items():
            need(
                isinstance(array, np.ndarray) and array.shape[:1] == (self.cells,),
                part,
                f"saves {name!r} as {np.shape(array)}; save NumPy arrays with cells as first axis",
            )
        if part.can(Ability.TALLY):
            need("tally" in arrays, part, "does not save its counts; save them as 'tally'")
        return {name: array.copy() for name, array in arrays.items()}

    def take_over(self, other: "Stage", arrays: dict[str, np.ndarray]) -> None:
        """Go on with the saved state of another stage."""
        self.habitat.load(arrays)
        self.age[:], self.alive[:] = other.age[self.who], other.alive[self.who]
        self.pasts = [[*past] if body in self.who else [] for body, past in enumerate(other.pasts)]

    def _tally(self) -> np.ndarray:
        tally, part = self.habitat.tally(), self.lives.habitat
        typed(part, "its tally", tally, (self.cells, len(part.tallies)), np.int32)
        return tally.copy()
