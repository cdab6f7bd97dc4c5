"""A life in a habitat on the host: brain and simulator by turns, in a habitat with one cell."""

from typing import Any

import jax
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.habitats.contract import HostHabitat, Outcome
from primordia.law.law import Law
from primordia.law.metabolism import ONE, Rates, metabolise
from primordia.organism.life.instant import Instant, Mind, Stretch, think
from primordia.random.wide import wide

ALONE = np.array([0])
"""The cell of one who lives by itself."""


class Hosted:
    """One organism in a habitat on the host, which is opened for it."""

    TICKS = 256
    """Kept at a time; a tick may have a picture of 120 kB."""

    def __init__(self, law: Law, mind: Mind, habitat: HostHabitat, watched: bool) -> None:
        habitat.open(1, watched)
        self._mind, self._habitat = mind, habitat
        self._think = shared(think, law)
        self._energies = shared(_energies) if law.metabolism is not None else None

    def born(self, words: Array) -> np.ndarray:
        """A fresh body from random words uint32 (1, words) -> its senses (1, S)."""
        return self._habitat.reset(ALONE, np.asarray(words))

    def found(self, stored: dict[str, np.ndarray]) -> np.ndarray:
        """The body that a checkpoint holds under names that begin with `bodies.` -> its senses."""
        bodies = {name.removeprefix("bodies."): array for name, array in stored.items()}
        senses = bodies.pop("senses")
        self._habitat.load(bodies)
        return senses

    def live(
        self, now: Instant, ticks: np.ndarray, rates: Rates, count: int
    ) -> tuple[Instant, Stretch]:
        """The first so many of TICKS ticks, with their rates (TICKS,)."""
        # in NumPy, since slicing JAX's arrays takes longer than a frame
        tick = jax.tree.map(np.asarray, wide(ticks))
        memory, senses, lived = now.memory, now.bodies, []
        for i in range(count):
            memory, action = self._think(self._mind, memory, senses, tick.take(np.s_[i : i + 1]))
            before, action = np.array(senses), np.asarray(action)
            senses, outcome = self._habitat.step(action, np.ones(1, bool))
            lived.append(_kept((before, action, self._habitat.seen(), outcome)))
        perceived, actions, bodies, outcomes = jax.tree.map(lambda *each: np.stack(each), *lived)
        energy = self._energy(now.energy, outcomes, rates)
        stretch = Stretch(
            ticks[:count], perceived, actions, bodies, energy[:count, 0] / ONE, outcomes.fatal
        )
        return Instant(memory, energy[count - 1], senses), stretch

    def _energy(self, energy: Array, outcomes: Outcome, rates: Rates) -> np.ndarray:
        """At the end of each tick, int32 (TICKS, 1); means nothing after those that were lived."""
        if self._energies is None:
            return np.tile(np.asarray(energy), (self.TICKS, 1))
        food, effort = (_padded(each, self.TICKS) for each in (outcomes.food, outcomes.effort))
        return np.asarray(self._energies(energy, food, effort, rates))

    def close(self) -> None:
        """Let go of what the habitat took."""
        self._habitat.close()


def _kept(seen: Any) -> Any:
    """The one body's part of everything, which the habitat may write over in the next tick."""
    return jax.tree.map(lambda leaf: np.array(leaf)[0], seen)


def _padded(amounts: Any, count: int) -> np.ndarray | None:
    """Float32 (n,) or None -> (count, 1): always as many, since JAX compiles anew for every shape."""
    if amounts is None:
        return None
    return np.pad(amounts.astype(np.float32), (0, count - len(amounts)))[:, None]


def _energies(energy: Array, food: Array | None, effort: Array | None, rates: Rates) -> Array:
    """Energy (1,) after each tick (n,) of what was eaten and exerted (n, 1) -> int32 (n, 1)."""

    def tick(energy: Array, given: tuple) -> tuple[Array, Array]:
        after = metabolise(energy, *given)
        return after, after

    return lax.scan(tick, energy, (food, effort, rates))[1]
