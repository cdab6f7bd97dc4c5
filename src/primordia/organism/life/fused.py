"""A life in a habitat in JAX: brain and body in one compiled loop."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.engine.state import named_leaves
from primordia.habitats.bodies import fresh
from primordia.habitats.contract import Bodies, JaxHabitat
from primordia.law.law import Law
from primordia.law.metabolism import ONE, Rates, metabolise
from primordia.organism.life.instant import Instant, Mind, Stretch, think
from primordia.random.wide import Wide, wide


class Fused:
    """One organism in a habitat in JAX."""

    TICKS = 4096
    """Lived in one compiled call."""

    def __init__(self, law: Law, mind: Mind, habitat: JaxHabitat) -> None:
        self._mind, self._habitat = mind, habitat
        self._lived = shared(_lived, law, habitat)

    def born(self, words: Array) -> Bodies:
        """A fresh body from random words uint32 (1, words)."""
        return shared(fresh, self._habitat)(words)

    def found(self, stored: dict[str, np.ndarray]) -> Bodies:
        """The body that a checkpoint holds under names that begin with `bodies`, (1, ...) each."""
        like = self._habitat.reset(jnp.zeros((1, self._habitat.words), jnp.uint32))
        leaves = [jnp.asarray(stored[name]) for name, _ in named_leaves({"bodies": like})]
        return jax.tree.unflatten(jax.tree.structure(like), leaves)

    def live(
        self, now: Instant, ticks: np.ndarray, rates: Rates, count: int
    ) -> tuple[Instant, Stretch]:
        """The first so many of TICKS ticks, with their rates (TICKS,); the rest are not looked at."""
        now, seen = self._lived(self._mind, now, wide(ticks), rates)
        senses, action, bodies, energy, fatal = jax.tree.map(
            lambda each: np.asarray(each[:count, 0]), seen
        )
        return now, Stretch(ticks[:count], senses, action, bodies, energy / ONE, fatal)

    def close(self) -> None:
        """Nothing to let go of."""


def _lived(
    law: Law, habitat: JaxHabitat, mind: Mind, now: Instant, ticks: Wide, rates: Rates
) -> tuple[Instant, tuple]:
    """One organism's ticks (n,) -> where it then stands; what there is to see, (n, 1, ...) each."""

    def step(now: Instant, given: tuple[Wide, Rates]) -> tuple[Instant, tuple]:
        tick, rates = given
        senses = habitat.sense(now.bodies)
        memory, action = think(law, mind, now.memory, senses, tick.map(jnp.atleast_1d))
        bodies, outcome = habitat.step(now.bodies, action)
        energy = now.energy
        if law.metabolism is not None:
            energy = metabolise(energy, outcome.food, outcome.effort, rates)
        seen = senses, action, bodies, energy, outcome.fatal
        return Instant(memory, energy, bodies), seen

    return lax.scan(step, now, (ticks, rates))
