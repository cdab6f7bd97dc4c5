"""A JAX habitat, stepped on the host: where an organism plays games rather than lives in a world."""

from typing import TYPE_CHECKING

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.compiled import shared
from primordia.habitats.bodies import broken, choose, fresh, put, unborn
from primordia.habitats.contract import (
    Ability,
    Bodies,
    Continuous,
    Discrete,
    HostHabitat,
    JaxHabitat,
    Outcome,
)

if TYPE_CHECKING:
    from PIL.Image import Image


class OnHost(HostHabitat):
    """A JAX habitat that keeps the contract of habitats on the host, with the same bits."""

    senses_size: int
    action: Discrete | Continuous
    words: int
    rate: float | None
    versions: dict[str, str]

    def __init__(self, inner: JaxHabitat) -> None:
        self.inner = inner
        self.senses_size, self.action, self.words = inner.senses_size, inner.action, inner.words
        self.rate, self.versions = inner.rate, inner.versions
        self._embody, self._step = shared(_embody, inner), shared(_step, inner)
        self._sense = shared(_sense, inner)

    def open(self, cells: int, watched: bool = False) -> None:
        """Make room for that many bodies."""
        self._bodies: Bodies = unborn(self.inner, cells)
        self._cells = cells

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells born (K,) from words uint32 (K, words) -> their senses (K, S)."""
        count = len(born)
        lacking = (1 << (count - 1).bit_length()) - count  # every K would be compiled by itself
        cells = np.pad(born, (0, lacking), constant_values=self._cells)
        filled = np.pad(words, ((0, lacking), (0, 0)))
        self._bodies, made = self._embody(self._bodies, cells, filled)
        return np.array(self._sense(made))[:count]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies in cells alive (N,) -> senses float32 (N, S), outcome."""
        self._bodies, outcome = self._step(self._bodies, action, alive)
        return np.array(self._sense(self._bodies)), outcome

    def seen(self) -> Bodies:
        """Return the bodies as NumPy arrays."""
        return jax.tree.map(np.asarray, self._bodies)

    def save(self) -> dict[str, np.ndarray]:
        """Return the leaves of the bodies, numbered."""
        return {f"body{i}": leaf for i, leaf in enumerate(jax.tree.leaves(self.seen()))}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Take back what `save` gave."""
        leaves = [jnp.asarray(arrays[f"body{i}"]) for i in range(len(arrays))]
        self._bodies = jax.tree.unflatten(jax.tree.structure(self._bodies), leaves)

    def lacks(self, ability: Ability) -> list[str]:
        """Return what the JAX habitat lacks to be drawn."""
        return self.inner.lacks(ability) if ability is Ability.PICTURE else super().lacks(ability)

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return the JAX habitat's picture."""
        return self.inner.picture(body, action)

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Return the JAX habitat's words."""
        return self.inner.caption(body, action)


def _embody(
    habitat: JaxHabitat, bodies: Bodies, cells: Array, words: Array
) -> tuple[Bodies, Bodies]:
    """Put fresh bodies (K, ...) into cells (K,), those out of range into none -> all, the fresh."""
    made = fresh(habitat, words)
    return put(bodies, cells, made), made


# Senses are a call of their own: compiled together with a step, they might be rounded otherwise.
def _sense(habitat: JaxHabitat, bodies: Bodies) -> Array:
    return habitat.sense(bodies)


def _step(
    habitat: JaxHabitat, bodies: Bodies, action: Array, alive: Array
) -> tuple[Bodies, Outcome]:
    """Step the bodies in cells alive; a body that is no longer finite is a fault."""
    after, outcome = habitat.step(bodies, action)
    fault = broken(after) if outcome.fault is None else broken(after) | outcome.fault
    fault = jnp.broadcast_to(fault, alive.shape)
    return choose(alive, after, bodies), outcome._replace(fault=fault)
