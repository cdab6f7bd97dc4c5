"""A life in a habitat of one cell on the host; brain and simulator take turns."""

import jax
import numpy as np
from jax import Array

from primordia.compiled import shared
from primordia.habitats.contract import HostHabitat
from primordia.law.law import Law
from primordia.law.metabolism import Rates
from primordia.organism.mind import Mind, perceiver, think
from primordia.organism.reliving.instant import Instant, Stretch, judged
from primordia.random.wide import wide

ONLY = np.array([0])
"""The number of the only cell."""


class LifeOnHost:
    """One organism alone in a habitat on the host."""

    TICKS = 256
    """Ticks of one stretch; a tick may have a picture of 120 kB."""

    def __init__(self, law: Law, mind: Mind, habitat: HostHabitat, watched: bool) -> None:
        habitat.open(1, watched)
        self._law, self._mind, self._habitat = law.alone, mind, habitat
        self._think, self._judged = (shared(each, self._law) for each in (think, judged))
        self._perceive = perceiver(self._law)

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
        self, now: Instant, ticks: np.ndarray, rates: Rates, given: np.ndarray, count: int
    ) -> tuple[Instant, Stretch]:
        """Live the first ticks, `count` in number, with their rates and endowments, int32 (TICKS,); see
        `judged`."""
        # NumPy arrays, since slicing a JAX array takes longer than a frame
        tick, rates = jax.tree.map(np.asarray, (wide(ticks), rates))
        lived = []
        for i in range(count):
            this = np.s_[i : i + 1]
            perceived = self._perceive(now.bodies, now.vitals.energy)
            thought = self._think(self._mind, now.memory, perceived, tick.take(this))
            before, action = np.array(perceived), np.asarray(thought.action)
            senses, outcome = self._habitat.step(action, np.ones(1, bool))
            own = Rates._make(None if each is None else each[this] for each in rates)
            now, cause = self._judged(now, thought, senses, outcome, own, given[this])
            seen, counts = self._habitat.seen(), self._counts()
            columns = before, action, seen, *now.vitals, cause, counts
            # The habitat may overwrite its arrays in the next tick.
            lived.append(jax.tree.map(lambda leaf: np.array(leaf)[0], columns))
        columns = jax.tree.map(lambda *each: np.stack(each), *lived)
        return now, Stretch(ticks[:count], *columns)

    def stored_as(self, bodies: np.ndarray) -> dict[str, np.ndarray]:
        """Return senses (1, S) as in a checkpoint; the habitat itself holds the body."""
        return {"bodies.senses": np.asarray(bodies)}

    def _counts(self) -> np.ndarray:
        """Return the habitat's counts, int32 (1, K)."""
        return self._habitat.tally() if self._habitat.tallies else np.zeros((1, 0), np.int32)

    def close(self) -> None:
        """Release the habitat's resources."""
        self._habitat.close()
