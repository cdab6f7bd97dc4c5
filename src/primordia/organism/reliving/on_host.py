"""A life in a habitat of one cell on the host; brain and simulator take turns."""

from typing import Any

import jax
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.habitats.contract import HostHabitat
from primordia.law.law import Law
from primordia.law.life import Vitals, judge
from primordia.law.metabolism import Rates
from primordia.organism.mind import Mind, think
from primordia.organism.reliving.instant import Instant, Stretch
from primordia.random.wide import wide

ONLY = np.array([0])
"""The number of the only cell."""


class LifeOnHost:
    """One organism alone in a habitat on the host."""

    TICKS = 256
    """Ticks of one stretch; a tick may have a picture of 120 kB."""

    def __init__(self, law: Law, mind: Mind, habitat: HostHabitat, watched: bool) -> None:
        habitat.open(1, watched)
        self._mind, self._habitat = mind, habitat
        self._think, self._judged = shared(think, law), shared(_judged, law)

    def embody(self, words: Array) -> np.ndarray:
        """Make a fresh body from random words uint32 (1, words). Return senses (1, S)."""
        return self._habitat.reset(ONLY, np.asarray(words))

    def restore(self, stored: dict[str, np.ndarray]) -> np.ndarray:
        """Load the body from a checkpoint's arrays with the prefix `bodies.`. Return senses (1, S)."""
        bodies = {name.removeprefix("bodies."): array for name, array in stored.items()}
        senses = bodies.pop("senses")
        self._habitat.load(bodies)
        return senses

    def live(
        self, now: Instant, ticks: np.ndarray, rates: Rates, count: int
    ) -> tuple[Instant, Stretch]:
        """Live the first ticks, `count` in number, with their rates (TICKS,)."""
        # NumPy arrays, since slicing a JAX array takes longer than a frame
        tick = jax.tree.map(np.asarray, wide(ticks))
        memory, senses, lived = now.memory, now.bodies, []
        for i in range(count):
            thought = self._think(self._mind, memory, senses, tick.take(np.s_[i : i + 1]))
            memory, before, action = thought.memory, np.array(senses), np.asarray(thought.action)
            senses, outcome = self._habitat.step(action, np.ones(1, bool))
            judged = thought.faulty, senses, outcome
            lived.append(_copied((before, action, self._habitat.seen(), self._counts(), judged)))
        perceived, actions, seen, counts, judged = jax.tree.map(
            lambda *each: np.stack(each), *lived
        )
        vitals, cause = self._judged(now.vitals, _padded(judged, self.TICKS), rates)
        after = jax.tree.map(lambda each: np.asarray(each)[:count], (*vitals, cause))
        lived = [ticks[:count], perceived, actions, seen, *(each[:, 0] for each in after), counts]
        stretch = Stretch._make(lived)
        energy, eaten, _ = (each[-1] for each in after)
        return Instant(memory, Vitals(energy, eaten), senses), stretch

    def stored_as(self, bodies: np.ndarray) -> dict[str, np.ndarray]:
        """Return senses (1, S) as in a checkpoint; the habitat itself holds the body."""
        return {"bodies.senses": np.asarray(bodies)}

    def _counts(self) -> np.ndarray:
        """Return the habitat's counts, int32 (1, K)."""
        return self._habitat.tally() if self._habitat.tallies else np.zeros((1, 0), np.int32)

    def close(self) -> None:
        """Release the habitat's resources."""
        self._habitat.close()


def _copied(values: Any) -> Any:
    """Copy the only body's part of arrays that the habitat may overwrite in the next tick."""
    return jax.tree.map(lambda leaf: np.array(leaf)[0], values)


def _padded(lived: Any, count: int) -> Any:
    """Pad arrays (n, ...) with zeros to (count, 1, ...), since JAX compiles for every new shape."""

    def leaf(array: np.ndarray) -> np.ndarray:
        grown = np.zeros((count, 1, *array.shape[1:]), array.dtype)
        grown[: len(array), 0] = array
        return grown

    return jax.tree.map(leaf, lived)


def _judged(law: Law, vitals: Vitals, lived: tuple, rates: Rates) -> tuple[Vitals, Array]:
    """Judge successive ticks. Return vitals and cause of death after each, int32 (n, 1).

    `lived` holds faulty (n, 1), senses after the tick (n, 1, S), and the outcome, (n, 1) each.
    """

    def tick(vitals: Vitals, given: tuple) -> tuple[Vitals, tuple[Vitals, Array]]:
        (faulty, senses, outcome), rates = given
        after, cause = judge(law, vitals, faulty, senses, outcome, rates)
        return after, (after, cause)

    return lax.scan(tick, vitals, (lived, rates))[1]
