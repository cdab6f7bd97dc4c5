"""A habitat as one island of an archipelago, with the senses, actions and counts of all islands."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia.errors import InputError
from primordia.habitats.around import AroundHost, AroundJax
from primordia.habitats.contract import (
    Action,
    AnyHabitat,
    Bodies,
    Continuous,
    Discrete,
    Outcome,
    Stepped,
)

if TYPE_CHECKING:
    from PIL.Image import Image

IDLE = "noop"
"""The name of the button that does nothing."""


class _OnIsland:
    """What a habitat as one island of an archipelago has in common in JAX and on the host."""

    inner: Any

    def __init__(self, inner: AnyHabitat, union: "Union") -> None:
        super().__init__(inner, union)  # type: ignore[call-arg]
        self.senses_size, self.action, self.words = union.senses, union.action, union.words
        self.tallies = union.tallies
        self._more = union.senses - inner.senses_size
        self._choice = _choices(inner, union)

    def _own(self, action: Any) -> Any:
        """Return the island's own actions for actions of the archipelago, (N,) or (N, A)."""
        if self._choice is not None:
            choice = self._choice if isinstance(action, np.ndarray) else jnp.asarray(self._choice)
            return choice[action]
        return action[:, : self.inner.action.size] if action.ndim == 2 else action

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return the island's picture."""
        return self.inner.picture(body, np.asarray(self._own(action[None]))[0])

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Return the island's caption."""
        return self.inner.caption(body, np.asarray(self._own(action[None]))[0])


class IslandInJax(_OnIsland, AroundJax):
    """One island in JAX."""

    def reset(self, words: Array) -> Bodies:
        """Return fresh bodies; see `JaxHabitat.reset`."""
        return self.inner.reset(words[:, : self.inner.words])

    def sense(self, bodies: Bodies) -> Array:
        """Return the island's senses, followed by zeros, float32 (N, S)."""
        senses = self.inner.sense(bodies)
        return jnp.pad(senses, ((0, 0), (0, self._more))) if self._more else senses

    def step(self, bodies: Bodies, action: Array) -> tuple[Bodies, Outcome]:
        """Step bodies by one tick; see `JaxHabitat.step`."""
        return self.inner.step(bodies, self._own(action))


class IslandOnHost(_OnIsland, AroundHost):
    """One island on the host."""

    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,); see `HostHabitat.reset`."""
        return self._wide(self.inner.reset(cells, words[:, : self.inner.words]))

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies of living cells; see `HostHabitat.step`."""
        return self.begin(action, alive)()

    def begin(self, action: np.ndarray, alive: np.ndarray) -> Callable[[], Stepped]:
        """Let the bodies of living cells begin; see `HostHabitat.begin`."""
        return partial(self._finish, self.inner.begin(self._own(action), alive))

    def _finish(self, finish: Callable[[], Stepped]) -> Stepped:
        senses, outcome = finish()
        return self._wide(senses), outcome

    def tally(self) -> np.ndarray:
        """Return the counts of all islands; those that this island lacks are 0, int32 (N, K)."""
        own = dict(zip(self.inner.tallies, self.inner.tally().T, strict=True))
        none = np.zeros(len(self.inner.tally()), np.int32)
        return np.stack([own.get(name, none) for name in self.tallies], axis=1)

    def _wide(self, senses: np.ndarray) -> np.ndarray:
        return np.pad(senses, ((0, 0), (0, self._more))) if self._more else senses


@dataclass(frozen=True)
class Union:
    """What all islands of an archipelago share."""

    senses: int
    action: Action
    words: int
    tallies: tuple[str, ...]
    buttons: tuple[str, ...]
    """the names of all choices, of a Discrete action"""

    @classmethod
    def of(cls, habitats: Sequence[AnyHabitat], names: Sequence[str]) -> "Union":
        """Return what the islands share.

        Raises:
            InputError: an island cannot take the actions of another one.
        """
        sizes = max(each.senses_size for each in habitats), max(each.words for each in habitats)
        actions = [each.action for each in habitats]
        kinds = {type(action) for action in actions}
        if len({*actions}) > 1 and (len(kinds) > 1 or not kinds <= {Discrete, Continuous}):
            raise InputError(
                "habitat.islands: all islands need the same kind of actions: choices, or amounts; "
                + ", ".join(f"{n} has {a}" for n, a in zip(names, actions, strict=True))
            )
        buttons: tuple[str, ...] = ()
        if isinstance(action := max(actions, key=lambda each: each.size), Discrete):
            named = [_buttons(each) for each in habitats]
            buttons = tuple(dict.fromkeys(name for own in named for name in own))
            for island, own in zip(names, named, strict=True):
                if IDLE not in own and (lacking := [each for each in buttons if each not in own]):
                    raise InputError(
                        f"habitat.islands: {island} lacks the button {lacking[0]!r} of another island,"
                        " and has no button that does nothing; give all islands the same actions"
                    )
            action = Discrete(len(buttons))
        elif isinstance(action, Continuous) and len({*actions}) > 1:
            action = Continuous(action.size)
        tallies = tuple(dict.fromkeys(name for each in habitats for name in each.tallies))
        return cls(sizes[0], action, sizes[1], tallies, buttons)


def _buttons(habitat: AnyHabitat) -> tuple[str, ...]:
    return habitat.buttons or tuple(map(str, range(habitat.action.size)))


def _choices(habitat: AnyHabitat, union: Union) -> np.ndarray | None:
    """Return the habitat's own choice for each button of all islands, int32; None for amounts, or if
    they are the same."""
    own = _buttons(habitat)
    if not union.buttons or own == union.buttons:
        return None
    return np.array([own.index(b if b in own else IDLE) for b in union.buttons], np.int32)
