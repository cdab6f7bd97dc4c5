"""A JAX habitat stepped on the host, for organisms that play games rather than live in a world."""

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.compiled import shared
from primordia.habitats.around import Around
from primordia.habitats.bodies import (
    insert_bodies,
    not_finite,
    placeholder_bodies,
    select_bodies,
)
from primordia.habitats.contract import (
    Ability,
    Bodies,
    HostHabitat,
    JaxHabitat,
    Outcome,
)


class OnHost(Around, HostHabitat):
    """A JAX habitat with the interface of habitats on the host; lives are the same, bit for bit."""

    def __init__(self, inner: JaxHabitat) -> None:
        super().__init__(inner)
        self._embody, self._step = shared(_embody, inner), shared(_step, inner)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Return no names: only the JAX habitat takes factors."""
        return ()

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate the bodies."""
        self._bodies: Bodies = placeholder_bodies(self.inner, cells)
        self._cells = cells

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,) from words uint32 (K, words); return the senses (K, S)."""
        count = len(cells)
        # K is padded to a power of two, since JAX compiles each shape separately.
        padding = (1 << (count - 1).bit_length()) - count
        padded_cells = np.pad(cells, (0, padding), constant_values=self._cells)
        padded_words = np.pad(words, ((0, padding), (0, 0)))
        self._bodies, senses = self._embody(self._bodies, padded_cells, padded_words)
        return np.array(senses)[:count]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step only the bodies of living cells; see `HostHabitat.step`."""
        self._bodies, senses, outcome = self._step(self._bodies, action, alive)
        return np.array(senses), outcome

    def seen(self) -> Bodies:
        """Return the bodies as NumPy arrays."""
        return jax.tree.map(np.asarray, self._bodies)

    def save(self) -> dict[str, np.ndarray]:
        """Return the leaves of the bodies, numbered."""
        return {f"body{i}": leaf for i, leaf in enumerate(jax.tree.leaves(self.seen()))}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the bodies that `save` returned."""
        leaves = [jax.device_put(np.array(arrays[f"body{i}"])) for i in range(len(arrays))]
        self._bodies = jax.tree.unflatten(jax.tree.structure(self._bodies), leaves)

    def lacks(self, ability: Ability) -> list[str]:
        """Return the methods that the habitat lacks for an ability. Pictures are drawn by the JAX
        habitat."""
        own = ability is not Ability.PICTURE
        return HostHabitat.lacks(self, ability) if own else self.inner.lacks(ability)


def _embody(
    habitat: JaxHabitat, bodies: Bodies, cells: Array, words: Array
) -> tuple[Bodies, Array]:
    """Insert fresh bodies into cells (K,), except those out of range; return all, and what the fresh
    ones sense."""
    newborn = habitat.reset(words)
    return insert_bodies(bodies, cells, newborn), habitat.sense(newborn)


def _step(
    habitat: JaxHabitat, bodies: Bodies, action: Array, alive: Array
) -> tuple[Bodies, Array, Outcome]:
    """Step the bodies of the cells alive, and sense all; a body that is no longer finite is a fault."""
    after, outcome = habitat.step(bodies, action)
    fault = not_finite(after) if outcome.fault is None else not_finite(after) | outcome.fault
    fault = jnp.broadcast_to(fault, alive.shape)
    bodies = select_bodies(alive, after, bodies)
    return bodies, habitat.sense(bodies), outcome._replace(fault=fault)
