"""The contract of habitats: the simulator side of a task, vectorised over cells.

A habitat knows nothing of energy, ages, neighbours or other organisms. It reports in physical units
what happened to its bodies; what that means for a life is decided by the law.

A habitat subclasses `JaxHabitat` or `HostHabitat`, alone or together with `Settings`:
`class Pond(JaxHabitat, Settings)`. It must have what is abstract here, and `senses_size`, `action` and
`words`; for everything else there is a default. `name` in a task's `[habitat]` table is one of KNOWN, or
`module:Class`. The other keys of the table are the class's own settings.

Simulators in worker processes load this file, so it imports neither JAX nor pydantic.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np

from primordia.settings import parts

if TYPE_CHECKING:
    from builtins import property as default

    from jax import Array
    from PIL.Image import Image

KNOWN = {
    "cartpole": "primordia.habitats.cartpole.habitat:CartPole",
    "atari": "primordia.habitats.atari.habitat:Atari",
    "mujoco": "primordia.habitats.mujoco.habitat:MuJoCo",
}

Bodies: TypeAlias = Any
"""A tree of arrays, each with cells as its first axis."""


@dataclass(frozen=True)
class Discrete:
    """An action is one of `size` choices: int32 (N,)."""

    size: int


@dataclass(frozen=True)
class Continuous:
    """An action is a vector: float32 (N, size). Its bounds are the habitat's to keep."""

    size: int


class Outcome(NamedTuple):
    """What happened to the bodies in one tick. None: this habitat never reports it."""

    fatal: "Array"
    """bool (N,): this body cannot live on."""
    food: "Array | None" = None
    """float32 (N,): what was gathered, in the task's unit (metres, points, targets)."""
    effort: "Array | None" = None
    """float32 (N,): what was exerted, in the habitat's unit."""
    fault: "Array | None" = None
    """bool (N,): the simulation of this body has failed; NaN and infinity are found by the law."""


class Ability(StrEnum):
    """What a habitat may be able to do; `habitat.can(Ability.PICTURE)` tells."""

    PICTURE = "picture"
    """its bodies can be drawn, for `primordia replay`"""
    TALLY = "tally"
    """it keeps counts for people, which the law never sees"""
    SAVE = "save"
    """its bodies can be stored and go on exactly"""


if not TYPE_CHECKING:

    class default:  # noqa: N801
        """A property that a subclass may replace by anything: an attribute, a property, a setting.

        It stores nothing and is hidden in the class itself, so that pydantic neither takes it for the
        value of a setting with the same name nor warns of one.
        """

        def __init__(self, compute: Callable) -> None:
            self._compute, self.__doc__ = compute, compute.__doc__

        def __get__(self, habitat: object, owner: type) -> Any:
            if habitat is None:
                raise AttributeError("a default; a habitat has it, its class has not")
            return self._compute(habitat)


class Habitat(ABC):
    """What habitats in JAX and on the host have in common; subclass one of these two."""

    abilities: ClassVar[Mapping[Ability, tuple[str, ...]]]
    """Methods that a class must define for each ability that it can have."""

    @default
    def senses_size(self) -> int:
        """Return the number of senses S. A habitat must have it."""
        raise _missing(self, "senses_size")

    @default
    def action(self) -> Discrete | Continuous:
        """Return what an action is. A habitat must have it."""
        raise _missing(self, "action")

    @default
    def words(self) -> int:
        """Return the number of random uint32 words that a birth needs. A habitat must have it."""
        raise _missing(self, "words")

    @default
    def versions(self) -> dict[str, str]:
        """Return name -> version of each package or file that lives depend on, beside this package.

        A run does not go on under other versions unless that is asked for.
        """
        return {}

    @default
    def rate(self) -> float | None:
        """Return ticks per second, where time is that of the world outside."""
        return None

    @default
    def episode(self) -> int | None:
        """Return the ticks after which a game is cut where others score it; None: it is not cut."""
        return None

    @default
    def tallies(self) -> tuple[str, ...]:
        """Return the names of what is counted for people, such as score."""
        return ()

    @default
    def exact(self) -> bool:
        """Return whether lives go on bit for bit from a checkpoint."""
        return self.can(Ability.SAVE)

    def can(self, ability: Ability) -> bool:
        """Return whether the habitat has an ability."""
        return ability in self.abilities and not self.lacks(ability)

    def lacks(self, ability: Ability) -> list[str]:
        """Return the methods that the class would have to define to have an ability."""
        own, defaults = type(self), HostHabitat
        needed = self.abilities[ability]
        return [name for name in needed if getattr(own, name) is getattr(defaults, name)]

    def check(self, cells: int) -> None:  # noqa: B027 - a default
        """Raise ValueError if a run of that many cells cannot be opened with these settings."""

    def original(self) -> "AnyHabitat | None":
        """Return the whole game as others score it: fatal is its end, food the score."""
        return None

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return a picture of one body (no first axis) and of the action that led there.

        `replay` writes two lines of words on it, 12 to 48 pixels from the top.
        """
        raise NotImplementedError

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Return the second line of words on a picture, such as the action's name and a score."""
        return f"action {np.array2string(np.asarray(action), precision=2)}"


class JaxHabitat(Habitat):
    """A habitat in JAX: pure functions, fused with the law into one compiled loop.

    Elementwise over bodies, the same bits for every N, and no random source but `words`. A class that is
    hashed and compared by its settings, as `Settings` are, shares compiled code with its equals.
    """

    kind: ClassVar[Literal["jax"]] = "jax"
    abilities: ClassVar = {Ability.PICTURE: ("picture",), Ability.SAVE: ()}

    @abstractmethod
    def reset(self, words: "Array") -> Bodies:
        """Return fresh bodies from random words uint32 (N, words)."""

    @abstractmethod
    def sense(self, bodies: Bodies) -> "Array":
        """Return what the organisms perceive, scaled, float32 (N, senses_size)."""

    @abstractmethod
    def step(self, bodies: Bodies, action: "Array") -> tuple[Bodies, Outcome]:
        """Step all bodies one tick. What comes out for a cell without an organism is not used."""


class HostHabitat(Habitat):
    """A habitat on the host, which owns its bodies and is stepped between two halves of the law."""

    kind: ClassVar[Literal["host"]] = "host"
    abilities: ClassVar = {
        Ability.PICTURE: ("picture", "seen"),
        Ability.TALLY: ("tally",),
        Ability.SAVE: ("save", "load"),
    }

    @abstractmethod
    def open(self, cells: int, watched: bool = False) -> None:
        """Make room for that many bodies; `watched` if there will be pictures of them."""

    @abstractmethod
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells born (K,) from words uint32 (K, words) -> their senses (K, S)."""

    @abstractmethod
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies in cells alive (N,), no others -> senses float32 (N, S), outcome."""

    def close(self) -> None:
        """Let go of what `open` took."""

    def seen(self) -> Bodies:
        """Return what `picture` and `caption` are given; the next tick may write over it."""
        return None

    def tally(self) -> np.ndarray:
        """Return the counts of the lives under way, int32 (N, K); `save` stores them as `tally`."""
        raise NotImplementedError

    def save(self) -> dict[str, np.ndarray]:
        """Return the bodies as arrays (N, ...): all that is needed to go on exactly."""
        return {}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Take back what `save` gave."""


AnyHabitat: TypeAlias = JaxHabitat | HostHabitat


def _missing(habitat: Habitat, name: str) -> TypeError:
    return TypeError(f"{type(habitat).__name__} is no habitat yet: it has no {name!r}")


def find(name: object) -> type[AnyHabitat]:
    """Return the habitat class called `name`.

    Raises:
        LookupError: there is no such name, module or class, or the class keeps no contract; the message
            says which.
    """
    found = parts.find("habitat", name, KNOWN)
    if not issubclass(found, JaxHabitat | HostHabitat):
        raise LookupError(
            f"{found.__name__} is no habitat: subclass JaxHabitat (with reset, sense and step) or"
            " HostHabitat (with open, reset and step) of primordia.habitats, and state senses_size,"
            " action and words"
        )
    return found


def complete(habitat: AnyHabitat) -> AnyHabitat:
    """Return a habitat that states all that has no default.

    Raises:
        TypeError: it does not; the message says what it lacks.
    """
    for name in ("senses_size", "action", "words"):
        getattr(habitat, name)
    if habitat.tallies and not habitat.can(Ability.TALLY):
        raise TypeError(
            f"{type(habitat).__name__} names tallies, which need a HostHabitat's tally()"
        )
    return habitat
