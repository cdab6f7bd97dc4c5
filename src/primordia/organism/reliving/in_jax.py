"""A life in a habitat in JAX: brain and body in one compiled loop."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array, lax

from primordia.compiled import shared
from primordia.engine.state import named_leaves
from primordia.habitats.contract import Bodies, JaxHabitat
from primordia.law.law import Law
from primordia.law.metabolism import Rates
from primordia.organism.mind import Mind, think
from primordia.organism.reliving.instant import Instant, Stretch, judged
from primordia.random.wide import Wide, wide


class LifeInJax:
    """One organism alone in a habitat in JAX."""

    TICKS = 4096
    """Ticks of one compiled call."""

    def __init__(self, law: Law, mind: Mind, habitat: JaxHabitat) -> None:
        self._mind, self._habitat = mind, habitat
        self._lived = shared(_lived, law.alone, habitat)

    def embody(self, words: Array) -> Bodies:
        """Return a fresh body from random words uint32 (1, words)."""
        return shared(type(self._habitat).reset, self._habitat)(words)

    def restore(self, stored: dict[str, np.ndarray]) -> Bodies:
        """Return the body, (1, ...) each, from a checkpoint's arrays whose names begin with `bodies`."""
        words = jax.ShapeDtypeStruct((1, self._habitat.words), np.uint32)
        like = jax.eval_shape(self._habitat.reset, words)  # computes and compiles nothing
        leaves = [jnp.asarray(stored[name]) for name, _ in named_leaves({"bodies": like})]
        return jax.tree.unflatten(jax.tree.structure(like), leaves)

    def live(
        self, now: Instant, ticks: np.ndarray, rates: Rates, given: np.ndarray, count: int
    ) -> tuple[Instant, Stretch]:
        """Live the first ticks, `count` in number, with their rates and endowments, int32 (TICKS,) (see
        `judged`); ignore the other ticks."""
        real = np.arange(len(ticks)) < count
        now, lived = self._lived(self._mind, now, (wide(ticks), rates, given, real))
        columns = jax.tree.map(lambda each: np.asarray(each)[:count, 0], lived)
        return now, Stretch._make([ticks[:count], *columns, np.zeros((count, 0), np.int32)])

    def stored_as(self, bodies: Bodies) -> dict[str, np.ndarray]:
        """Return a body (1, ...) as a checkpoint holds it, by the names of the arrays."""
        return {name: np.asarray(leaf) for name, leaf in named_leaves({"bodies": bodies})}

    def close(self) -> None:
        """Do nothing: there are no resources to release."""


def _lived(
    law: Law, habitat: JaxHabitat, mind: Mind, now: Instant, ticks: tuple[Wide, Rates, Array, Array]
) -> tuple[Instant, tuple]:
    """Live ticks (n,). Return the state after them, and the columns of a Stretch, each (n, 1, ...).

    `ticks` holds the ticks' numbers, their rates, the endowments of children, and whether each tick is
    real; padding leaves the state unchanged.
    """

    def step(now: Instant, each: tuple[Wide, Rates, Array, Array]) -> tuple[Instant, tuple]:
        tick, rates, given, real = each
        senses = law.perceived(habitat.sense(now.bodies), now.vitals.energy)
        thought = think(law, mind, now.memory, senses, tick.map(jnp.atleast_1d))
        bodies, outcome = habitat.step(now.bodies, thought.action)
        after, cause = judged(law, now, thought, bodies, outcome, rates, given)
        columns = senses, thought.action, bodies, *after.vitals, cause
        return jax.tree.map(lambda new, old: jnp.where(real, new, old), after, now), columns

    return lax.scan(step, now, ticks)
