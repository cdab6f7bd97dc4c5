"""The compared values of a life: as recorded, and as found when the life was lived again."""

import hashlib
from collections.abc import Iterator, Mapping
from typing import TypeAlias

import numpy as np

from primordia.habitats.archipelago import body_in
from primordia.law.metabolism import ONE
from primordia.law.world import Cause
from primordia.organism.reliving.instant import Stretch
from primordia.organism.reliving.relived import RelivedLife

Value: TypeAlias = int | float | str | None
ALIVE = "alive"
"""The word for the living, in place of a cause of death."""
OWN = tuple(f"world.organisms.{name}" for name in ("memory", "energy", "eaten"))
"""Names of the arrays in a state whose values change during an organism's life."""
BODIES, SENSES, COUNTS = "bodies", ("bodies.senses",), "bodies.tally"
"""Names in a state: the prefix of a body's arrays, the senses of a habitat on the host, the counts."""


def recorded(life: RelivedLife) -> dict[str, Value]:
    """Return the recorded values of a life, by name.

    For the dead: tick and cause of death, energy left, food eaten, and the habitat's counts. For
    the living: energy, food and counts at the newest checkpoint, and digests of the memory and of
    the body or its senses.
    """
    names = life.run.schema.tallies
    if life.cause is not None:
        energy, food = life.at_death
        counts = {name: life.death[name] for name in names}
        return {"tick": life.ends, "cause": life.cause.label, **_vitals(energy, food), **counts}
    place = life.world * life.config.cells + int(life.record.cell[0])
    state = life.run.state
    body = body_in(state, life.config.islands, place)
    if life.habitat.kind == "host":
        body = {name: body[name] for name in SENSES}
    held = {name: state[name][place : place + 1] for name in OWN} | body
    lived = names if life.begins < life.ends else ()
    counts = dict(zip(lived, state[COUNTS][place].tolist(), strict=True)) if lived else {}
    return {"tick": life.ends, "cause": ALIVE, **_of_living(held), **counts}


class Course:
    """The course of a life that is lived again, regardless of the record."""

    def __init__(self, life: RelivedLife) -> None:
        """Prepare the life; `stretches` lives it."""
        self._life = life
        self._held: dict[str, np.ndarray] = {}
        self._last: Stretch | None = None

    def stretches(self) -> Iterator[Stretch]:
        """Live the life, and yield it some ticks at a time; see `RelivedLife.instants`."""
        for held, stretch in self._life.instants():
            self._held = held
            if stretch is not None:
                self._last = stretch
                yield stretch

    @property
    def tick(self) -> int:
        """The last tick that was lived."""
        return self._life.begins if self._last is None else int(self._last.tick[-1])

    @property
    def replaced(self) -> bool:
        """Whether the organism still lived at the tick at which, on record, a child took its cell."""
        life, lives = self._life, self._life.run.lives
        if life.cause is not Cause.REPLACED or self._cause >= 0:
            return False
        child = (lives.world == life.world) & (lives.cell == life.record.cell)
        return bool((child & (lives.born == life.ends)).any())

    @property
    def _cause(self) -> int:
        return -1 if self._last is None else int(self._last.cause[-1])

    def found(self) -> dict[str, Value]:
        """Return the values found in the life, under the names that `recorded` returns."""
        if self._cause < 0 and not self.replaced:
            ended = {"cause": ALIVE} | ({"tick": self.tick} if self._life.cause is None else {})
            held = _of_living(self._held)
        else:
            cause = Cause(self._cause) if self._cause >= 0 else Cause.REPLACED
            ended, held = {"cause": cause.label, "tick": self.tick}, {}
        if self._last is not None:
            held |= _vitals(int(self._last.energy[-1]), int(self._last.eaten[-1]))
            counts = self._last.counts[-1].tolist()
            held |= dict(zip(self._life.run.schema.tallies, counts, strict=True))
        return ended | held


def _vitals(energy: int, eaten: int) -> dict[str, Value]:
    return {"energy": energy / ONE, "food": eaten / ONE}


def _of_living(held: Mapping[str, np.ndarray]) -> dict[str, Value]:
    """Return energy, food and digests of memory and body, from arrays (1, ...) of a state."""
    memory, energy, eaten = (held[name] for name in OWN)
    body = {name: held[name] for name in sorted(held) if name.startswith(BODIES)}
    name = "senses" if list(body) == list(SENSES) else "body"
    seen = _digest(*body.values())
    return _vitals(int(energy[0]), int(eaten[0])) | {"memory": _digest(memory), name: seen}


def _digest(*arrays: np.ndarray) -> str:
    """Return the first digits of a checksum of the bits of arrays."""
    content = b"".join(np.ascontiguousarray(each).tobytes() for each in arrays)
    return hashlib.sha256(content).hexdigest()[:12]
