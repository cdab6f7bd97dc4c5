"""Habitats around another habitat: everything is passed on, except what a subclass changes."""

from typing import TYPE_CHECKING, Any

import numpy as np
from jax import Array

from primordia.habitats.contract import (
    Ability,
    Action,
    AnyHabitat,
    Bodies,
    Habitat,
    HostHabitat,
    JaxHabitat,
    Outcome,
)

if TYPE_CHECKING:
    from PIL.Image import Image


class _Around(Habitat):
    """The properties and pictures of the inner habitat. Equal ones share compiled code."""

    senses_size: int
    action: Action
    words: int
    versions: dict[str, str]
    rate: float | None
    episode: int | None
    tallies: tuple[str, ...]
    exact: bool
    buttons: tuple[str, ...] | None

    def __init__(self, inner: AnyHabitat, *own: Any) -> None:
        """Wrap a habitat; `own` are all settings of the wrapper, which can be compared and hashed."""
        self.inner: Any = inner
        self._key = (type(self), inner, own)
        self.senses_size, self.action, self.words = inner.senses_size, inner.action, inner.words
        self.versions, self.rate, self.episode = inner.versions, inner.rate, inner.episode
        self.tallies, self.exact, self.buttons = inner.tallies, inner.exact, inner.buttons

    @property
    def parameters(self) -> tuple[str, ...]:
        """Return the names of the inner habitat's physical parameters."""
        return self.inner.parameters

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Around) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def lacks(self, ability: Ability) -> list[str]:
        """Return the methods that the inner habitat lacks for an ability."""
        return self.inner.lacks(ability)

    def original(self) -> AnyHabitat | None:
        """Return the inner habitat as the standard benchmark scores it, without this wrapper."""
        return self.inner.original()

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return the inner habitat's picture."""
        return self.inner.picture(body, action)

    def picture_scaled(self, body: Bodies, action: np.ndarray, factors: np.ndarray) -> "Image":
        """Return the inner habitat's picture of a body with other parameters."""
        return self.inner.picture_scaled(body, action, factors)

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Return the inner habitat's caption."""
        return self.inner.caption(body, action)


class AroundJax(_Around, JaxHabitat):
    """A habitat in JAX around another."""

    inner: JaxHabitat

    def reset(self, words: Array) -> Bodies:
        """Return fresh bodies; see `JaxHabitat.reset`."""
        return self.inner.reset(words)

    def sense(self, bodies: Bodies) -> Array:
        """Return the senses; see `JaxHabitat.sense`."""
        return self.inner.sense(bodies)

    def step(self, bodies: Bodies, action: Array) -> tuple[Bodies, Outcome]:
        """Step all bodies by one tick; see `JaxHabitat.step`."""
        return self.inner.step(bodies, action)

    def step_scaled(self, bodies: Bodies, action: Array, factors: Array) -> tuple[Bodies, Outcome]:
        """Step bodies with other parameters by one tick; see `JaxHabitat.step_scaled`."""
        return self.inner.step_scaled(bodies, action, factors)


class AroundHost(_Around, HostHabitat):
    """A habitat on the host around another."""

    inner: HostHabitat

    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate a body for each of N cells; see `HostHabitat.open`."""
        self.inner.open(cells, watched)

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,); see `HostHabitat.reset`."""
        return self.inner.reset(cells, words)

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies of living cells; see `HostHabitat.step`."""
        return self.inner.step(action, alive)

    def close(self) -> None:
        """Release what `open` allocated."""
        self.inner.close()

    def seen(self) -> Bodies:
        """Return the bodies for `picture` and `caption`."""
        return self.inner.seen()

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        """Multiply parameters of some bodies; see `HostHabitat.set_factors`."""
        self.inner.set_factors(cells, factors)

    def tally(self) -> np.ndarray:
        """Return the counts of the inner habitat."""
        return self.inner.tally()

    def message(self, cell: int) -> str:
        """Return why the body in a cell failed."""
        return self.inner.message(cell)

    def save(self) -> dict[str, np.ndarray]:
        """Return the arrays of the inner habitat."""
        return self.inner.save()

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore what `save` returned."""
        self.inner.load(arrays)


def inside(habitat: AnyHabitat, kind: type) -> Any:
    """Return the habitat itself, or the one inside it, that is of a kind; None if there is none."""
    while isinstance(habitat, _Around):
        if isinstance(habitat, kind):
            return habitat
        habitat = habitat.inner
    return habitat if isinstance(habitat, kind) else None


def innermost(habitat: AnyHabitat) -> AnyHabitat:
    """Return the habitat without all that is around it."""
    while isinstance(habitat, _Around):
        habitat = habitat.inner
    return habitat
