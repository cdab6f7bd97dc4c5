"""Habitats: the simulator side of a task, vectorised over cells.

A habitat knows nothing of energy, ages, neighbours or other organisms. It reports what befell its
bodies in physical units; what that means for a life is the law's.

`name` in a task's `[habitat]` table is one of those listed here, or `module:Class` of anything
that keeps the contract below. The other keys of the table are the class's own settings.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from primordia.settings import parts

if TYPE_CHECKING:
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
    """What befell the bodies in one tick. None is: this habitat never has any of it."""

    fatal: "Array"
    """bool (N,): this body cannot live on."""
    food: "Array | None" = None
    """float32 (N,): what was gathered, in the task's unit (metres, points, targets)."""
    effort: "Array | None" = None
    """float32 (N,): what was exerted, in the habitat's unit."""
    fault: "Array | None" = None
    """bool (N,): the simulation of this body has failed; NaN and infinity are found by the law."""


class Habitat(Protocol):
    """A habitat in JAX: pure functions, fused with the law into one compiled loop.

    Elementwise over cells, the same bits for every N, and no random source but `words`.
    """

    senses_size: int
    action: Discrete | Continuous
    words: int
    """How many random uint32 words a birth needs."""

    def reset(self, words: "Array") -> Bodies:
        """Fresh bodies from random words uint32 (N, words)."""

    def sense(self, bodies: Bodies) -> "Array":
        """What the organisms perceive, scaled, float32 (N, senses_size)."""

    def step(self, bodies: Bodies, action: "Array") -> "tuple[Bodies, Outcome]":
        """All bodies one tick on. What it gives for a cell nobody lives in is not used."""


class Pictured(Protocol):
    """What a habitat has besides, if its bodies can be seen (`primordia replay`)."""

    rate: float
    """ticks in a second, where time runs as it would in the world outside"""

    def picture(self, body: Bodies, action: np.ndarray) -> "Image":
        """A picture of one body (no first axis) and of the action that led there."""


class Captioned(Protocol):
    """What a habitat has besides, if its pictures are to be explained in words."""

    def caption(self, body: Bodies, action: np.ndarray) -> str:
        """Such as the action's name and a score. `replay` writes it 32 to 48 pixels from the top."""


class Seen(Protocol):
    """What a habitat on the host has besides, if its bodies can be looked at.

    They are what `picture` and `caption` are given; a habitat in JAX has them anyway.
    """

    def open(self, cells: int, watched: bool = False) -> None:
        """Make room for so many bodies; `watched` if there will be pictures of them."""

    def seen(self) -> Bodies:
        """What there is to see of the bodies now; it may be written over in the next tick."""


class Tallied(Protocol):
    """What a habitat on the host has besides, if it counts what people want to know of a life."""

    tallies: tuple[str, ...]
    """what is counted, such as score"""

    def tally(self) -> np.ndarray:
        """Of the lives under way, int32 (N, K); the law never sees it. `save` has it as `tally`."""


class Versioned(Protocol):
    """What a habitat has besides, if its lives depend on more than its settings and this package."""

    versions: dict[str, str]
    """name -> version of each package or file; where one differs, a run does not go on unasked"""


class Scored(Protocol):
    """What a habitat has besides, if others have scored play in it (`primordia evaluate`)."""

    episode: int | None
    """ticks after which a game is cut, if others cut it; it need not be there"""

    def original(self) -> "Habitat | HostHabitat | None":
        """The whole game: fatal is its end, and food the score. None: nobody scores it."""


class HostHabitat(Protocol):
    """A habitat that runs on the host, stepped between two halves of the law.

    It owns its bodies. Cells that are not `alive` are not stepped. It may also have `exact = False`,
    if it cannot save them, and `close()`, to let go of what `open` took.
    """

    senses_size: int
    action: Discrete | Continuous
    words: int

    def open(self, cells: int) -> None:
        """Make room for so many bodies."""

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        """Fresh bodies in cells born (K,) from words uint32 (K, words) -> their senses (K, S)."""

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        """Step the bodies in cells alive (N,) -> senses float32 (N, S), outcome."""

    def save(self) -> dict[str, np.ndarray]:
        """The bodies as arrays (N, ...): all that is needed to go on exactly."""

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        """Take back what `save` gave."""


def find(name: object) -> type:
    """Return the habitat class called `name`.

    Raises:
        LookupError: there is no such name, module or class; the message says which.
    """
    return parts.find("habitat", name, KNOWN)
