"""The contract of habitats: the simulator side of a task, vectorised over cells.

A habitat knows nothing of energy, ages, neighbours or other organisms. It reports in physical units
what happened to its bodies; the law decides what that means for a life.

A habitat is a subclass of `JaxHabitat` or `HostHabitat`, alone or together with `Settings`:
`class Pond(JaxHabitat, Settings)`. The subclass must define all abstract methods, and `senses_size`,
`action` and `words`. Everything else has a default. `name` in a task's `[habitat]` table is one of KNOWN,
or `module:Class`. The other keys of the table are the class's own settings.

Simulators in worker processes load this file, so it imports neither JAX nor pydantic.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np

from primordia.habitats.actions import Action as Action
from primordia.habitats.actions import Compound as Compound
from primordia.habitats.actions import Continuous as Continuous
from primordia.habitats.actions import Discrete as Discrete
from primordia.settings import parts

if TYPE_CHECKING:
    from builtins import property as default

    from jax import Array
    from PIL.Image import Image

KNOWN = {
    "cartpole": "primordia.habitats.cartpole.habitat:CartPole",
    "atari": "primordia.habitats.atari.habitat:Atari",
    "gymnax": "primordia.habitats.gymnax.habitat:Gymnax",
    "mujoco": "primordia.habitats.mujoco.habitat:MuJoCo",
    "gymnasium": "primordia.habitats.gymnasium.habitat:Gymnasium",
}

Bodies: TypeAlias = Any
"""A tree of arrays, each with cells as its first axis."""


class Outcome(NamedTuple):
    """The results of one tick for the bodies; None for a result that the habitat does not report."""

    fatal: "Array"
    """bool (N,): the tick is fatal for the body"""
    food: "Array | None" = None
    """float32 (N,): food gathered, in the task's unit (metres, points, targets)"""
    effort: "Array | None" = None
    """float32 (N,): effort exerted, in the habitat's unit"""
    capacity: "Array | None" = None
    """float32 (N,): how much energy the body holds at most, as a share of `metabolism.cap`"""
    expired: "Array | None" = None
    """bool (N,): the habitat's own time limit ends the life"""
    fault: "Array | None" = None
    """bool (N,): the body's simulation has failed; the law itself detects NaN and infinity"""


Stepped: TypeAlias = tuple[np.ndarray, Outcome]
"""Senses float32 (N, S) and outcome of a step on the host."""


class Ability(StrEnum):
    """Optional abilities of a habitat; `habitat.can(Ability.PICTURE)` is true if it draws pictures."""

    PICTURE = "picture"
    """draw bodies, for `primordia replay`"""
    TALLY = "tally"
    """keep counts that only people read, such as a score; the law never sees these counts"""
    SAVE = "save"
    """save bodies, so that they go on exactly"""
    SCALE = "scale"
    """multiply physical parameters of each body by factors, for traits and for changes within a life"""


if not TYPE_CHECKING:

    class default:  # noqa: N801
        """A property that a subclass may replace by an attribute, a property or a setting.

        The property is invisible on the class itself. So pydantic does not take it for the default
        of a setting with the same name, and does not warn that the setting hides it.
        """

        def __init__(self, compute: Callable) -> None:
            self._compute, self.__doc__ = compute, compute.__doc__

        def __get__(self, habitat: object, owner: type) -> Any:
            if habitat is None:
                raise AttributeError(
                    "this default can be read from a habitat, but not from the class of the habitat"
                )
            return self._compute(habitat)


class Habitat(ABC):
    """The common part of `JaxHabitat` and `HostHabitat`, the base classes of all habitats."""

    abilities: ClassVar[Mapping[Ability, tuple[str, ...]]]
    """Methods that a class must define for each ability."""

    @default
    def senses_size(self) -> int:
        """Return the number of senses S. A habitat must state it."""
        raise _missing(self, "senses_size")

    @default
    def action(self) -> Action:
        """Return the kind of actions. A habitat must state it."""
        raise _missing(self, "action")

    @default
    def words(self) -> int:
        """Return the number of random uint32 words that a birth needs. A habitat must state it."""
        raise _missing(self, "words")

    @default
    def versions(self) -> dict[str, str]:
        """Return the versions of packages and files, other than this package, on which lives depend.

        A run under other versions is resumed only if the user asks for it.
        """
        return {}

    @default
    def rate(self) -> float | None:
        """Return the ticks in a second of simulated time; None if simulated time has no unit."""
        return None

    @default
    def episode(self) -> int | None:
        """Return the ticks after which the standard benchmark ends a game; None: it ends no game."""
        return None

    @default
    def tallies(self) -> tuple[str, ...]:
        """Return the names of the counts, such as a score, that are kept only for people to read."""
        return ()

    @default
    def parameters(self) -> tuple[str, ...]:
        """Return the names of the P physical parameters, such as gravity, that may change within a life.

        Each body has a factor for each of them. A habitat that names some must be able to SCALE.
        """
        return ()

    @default
    def buttons(self) -> tuple[str, ...] | None:
        """Return the name of each choice of a Discrete action; None: the choices have no names.

        Islands of one archipelago share buttons with equal names. The button `noop` does nothing.
        """
        return None

    @default
    def exact(self) -> bool:
        """Return whether lives go on bit for bit from a checkpoint."""
        return self.can(Ability.SAVE)

    def can(self, ability: Ability) -> bool:
        """Return whether the habitat has an ability."""
        return ability in self.abilities and not self.lacks(ability)

    def lacks(self, ability: Ability) -> list[str]:
        """Return the methods that the class lacks for an ability."""
        own, defaults = type(self), JaxHabitat if isinstance(self, JaxHabitat) else HostHabitat
        needed = self.abilities[ability]
        return [name for name in needed if getattr(own, name) is getattr(defaults, name)]

    @staticmethod
    def files_with(file: str) -> list[str]:
        """Return the full paths of a file that a setting names, and of all files that this file needs.

        Settings that name files are `file` and all others that end in `_file`. Each run keeps copies of
        these files, and its lives use them. The default: the file needs no other.
        """
        return [file]

    def original(self) -> "AnyHabitat | None":
        """Return a habitat for the whole game as the standard benchmark scores it; None if there is none.

        Food is the score, and the end of the game is fatal.
        """
        return None

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """Return a picture of one body (no first axis) and of the action that led to it.

        `replay` writes two lines of captions on it, 12 to 48 pixels from the top.
        """
        raise NotImplementedError

    def picture_scaled(self, body: Bodies, action: np.ndarray, factors: np.ndarray) -> "Image":
        """Return a picture of a body whose `parameters` are multiplied by factors, float32 (P,).

        By default they are not to be seen: the picture is that of `picture`.
        """
        return self.picture(body, action)

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Return the second line of a picture's captions, such as the action's name and a score."""
        if self.buttons:
            return f"button {self.buttons[int(action)]}"
        return f"action {np.array2string(np.asarray(action), precision=2)}"


class JaxHabitat(Habitat):
    """A habitat in JAX: pure functions, fused with the law into one compiled loop.

    The functions treat each body by itself, give the same bits for every N, and take all randomness
    from the argument `words`. Habitats that are equal share compiled code, so hash and compare them
    by their settings, as `Settings` do.
    """

    kind: ClassVar[Literal["jax"]] = "jax"
    abilities: ClassVar = {
        Ability.PICTURE: ("picture",),
        Ability.SAVE: (),
        Ability.SCALE: ("step_scaled",),
    }

    @abstractmethod
    def reset(self, words: "Array") -> Bodies:
        """Return fresh bodies from random words uint32 (N, words)."""

    @abstractmethod
    def sense(self, bodies: Bodies) -> "Array":
        """Return the scaled senses of the organisms, float32 (N, senses_size)."""

    @abstractmethod
    def step(self, bodies: Bodies, action: "Array") -> tuple[Bodies, Outcome]:
        """Step all bodies by one tick. The results of a cell without an organism are not used."""

    def step_scaled(
        self, bodies: Bodies, action: "Array", factors: "Array"
    ) -> tuple[Bodies, Outcome]:
        """Step bodies whose `parameters` are multiplied by factors, float32 (N, P), in this tick."""
        raise NotImplementedError


class HostHabitat(Habitat):
    """A habitat on the host, which owns its bodies; the engine steps it between two halves of the law."""

    kind: ClassVar[Literal["host"]] = "host"
    abilities: ClassVar = {
        Ability.PICTURE: ("picture", "seen"),
        Ability.TALLY: ("tally",),
        Ability.SAVE: ("save", "load"),
        Ability.SCALE: ("set_factors",),
    }

    @abstractmethod
    def open(self, cells: int, watched: bool = False) -> None:
        """Allocate a body for each of N cells; `watched` is true if `picture` will be called."""

    @abstractmethod
    def reset(self, cells: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Make fresh bodies in cells (K,) from words uint32 (K, words); return the senses (K, S)."""

    @abstractmethod
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step only the bodies of living cells; return senses, float32 (N, S), and outcome.

        `alive` is bool (N,). The results of the other cells are not used.
        """

    def begin(self, action: np.ndarray, alive: np.ndarray) -> Callable[[], Stepped]:
        """Begin a step, and return the function that ends it, with the results of `step`.

        A habitat whose simulators are other processes may let them begin, so that several islands step
        at the same time. By default everything is done at the end.
        """
        return partial(self.step, action, alive)

    def close(self) -> None:
        """Release what `open` allocated."""

    def seen(self) -> Bodies:
        """Return the bodies for `picture` and `caption`; the next tick may overwrite them."""
        return None

    def set_factors(self, cells: np.ndarray, factors: np.ndarray) -> None:
        """Multiply the `parameters` of the bodies in cells (K,) by factors, float32 (K, P), from now on.

        The factors are 1 when the habitat is opened. `reset` and `load` leave them unchanged.
        """
        raise NotImplementedError

    def tally(self) -> np.ndarray:
        """Return the counts of the present lives, int32 (N, K); `save` stores them as `tally`."""
        raise NotImplementedError

    def message(self, cell: int) -> str:
        """Return why the body in a cell failed in the latest tick, in one line; "" if that is unknown."""
        return ""

    def save(self) -> dict[str, np.ndarray]:
        """Return the whole state of the bodies as arrays (N, ...), so that bodies go on exactly."""
        return {}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the state that `save` returned."""


AnyHabitat: TypeAlias = JaxHabitat | HostHabitat


def _missing(habitat: Habitat, name: str) -> TypeError:
    return TypeError(
        f"{type(habitat).__name__} is not a complete habitat: it has no {name!r}; define {name} as"
        " an attribute or a property of the class"
    )


def find(name: object) -> type[AnyHabitat]:
    """Return the habitat class with this name.

    Raises:
        LookupError: there is no such name, module or class, or the class is not a habitat; the message
            says which.
    """
    kind = parts.find("habitat", name, KNOWN, object)
    if not issubclass(kind, JaxHabitat | HostHabitat):
        raise LookupError(
            f"{kind.__name__} is not a habitat: make it a subclass of JaxHabitat (with reset, sense and"
            " step) or HostHabitat (with open, reset and step) of primordia.habitats, and define"
            " senses_size, action and words"
        )
    return kind
