"""Checks of habitats: what keeps its contract passes, and each fault is caught and named."""

from typing import Any, ClassVar
from unittest.mock import Mock

import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from primordia.config import load
from primordia.habitats import Compound, Continuous, Discrete, HostHabitat, JaxHabitat, Outcome
from primordia.settings.base import Settings
from primordia.testing import ContractError, check_habitat
from primordia.testing import habitat as checks
from tests.testing.impure import counted


@pytest.mark.slow
def test_robots_keep_the_contract() -> None:
    pytest.importorskip("mujoco")
    check_habitat(load("Reacher-forager").build_habitat())


@pytest.mark.slow  # starts emulators nine times
def test_games_keep_the_contract() -> None:
    pytest.importorskip("ale_py")
    check_habitat(load("Pong-survival").build_habitat())


class Still(JaxHabitat, Settings):
    """Bodies that stay where they are born."""

    senses_size: ClassVar = 2
    action: ClassVar = Continuous(2)
    words: ClassVar = 2

    def reset(self, words: Array) -> Array:
        return (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)

    def sense(self, bodies: Array) -> Array:
        return bodies

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies, Outcome(jnp.zeros(len(bodies), bool))


class Pair(Still):
    """Bodies of two parts that an action of several parts moves, until they expire."""

    action: ClassVar = Compound((Discrete(3), Continuous(2)))

    def reset(self, words: Array) -> Any:
        return super().reset(words), jnp.zeros(len(words), jnp.int32)

    def sense(self, bodies: Any) -> Array:
        return bodies[0]

    def step(self, bodies: Any, action: Array) -> tuple[Any, Outcome]:
        place, clock = bodies[0] + action[:, 1:], bodies[1] + 1
        fallen = (action[:, 0] == 1) & (place[:, 0] > 1)
        return (place, clock), Outcome(fallen, food=place[:, 1], expired=clock >= 6)


class Coupled(Still):
    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return super().step(bodies - action.mean(axis=0), action)


class Moody(Still):
    def reset(self, words: Array) -> Array:
        return super().reset(words) + counted()


class Changeable(Still):
    """A habitat whose capacity has another value in each trace; `test_loops` has other values."""

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        value = jnp.full(len(bodies), counted(), jnp.float32)
        return bodies, super().step(bodies, action)[1]._replace(capacity=value)


class Sloppy(Still):
    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies, Outcome(jnp.zeros(len(bodies), bool), food=bodies[:, :1])


class Wide(Still):
    senses_size: ClassVar = 3


class Melting(Still):
    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return super().step(bodies.astype(jnp.float16), action)


class Changing(Still):
    def step(self, bodies: Array, action: Array) -> Any:
        return (bodies, bodies), Outcome(jnp.zeros(len(bodies), bool))


class Mute(Still):
    def step(self, bodies: Array, action: Array) -> Any:
        return bodies, jnp.zeros(len(bodies), bool)


class Senseless(JaxHabitat):
    action, words = Discrete(2), 1
    reset, sense, step = Still.reset, Still.sense, Still.step


class Choiceless(Still):
    action: ClassVar = Discrete(1)


JAX_FAULTS: list[tuple[Any, str]] = [
    (
        Coupled(),
        "body .* has a different life at age 1 among 1 bodies than among 32; .* elementwise",
    ),
    (Moody(), "when it is traced again, so it draws from more than `words`"),
    (Changeable(), "when it is traced again"),
    (Sloppy(), r"gives outcome.food as float32 \(32, 1\); the contract says float32 \(32,\)"),
    (Wide(), r"gives senses as float32 \(32, 2\); the contract says float32 \(32, 3\)"),
    (Melting(), "gives bodies after a step as float16"),
    (Changing(), "bodies of different forms in step and in reset"),
    (Mute(), "returns .* from step; return an Outcome"),
    (Senseless(), "has no 'senses_size'; define senses_size as an attribute"),
    (Choiceless(), r"has action = Discrete\(size=1\); it must be Discrete\(2\) or more"),
]


# Habitats on the host that do not.


class Wagon(HostHabitat):
    """Bodies with a place and a speed, which an action changes."""

    senses_size, action, words = 1, Discrete(2), 1

    def open(self, cells: int, watched: bool = False) -> None:
        self.place, self.speed = np.zeros((2, cells, 1), np.float32)

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.place[born], self.speed[born] = words % 7, 0
        return self.place[born]

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        self.speed[alive, 0] += action[alive]
        self.place[alive] += self.speed[alive]
        return self.place.copy(), Outcome(self.place[:, 0] > 40)

    def save(self) -> dict[str, np.ndarray]:
        return {"place": self.place, "speed": self.speed}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.place, self.speed = arrays["place"], arrays["speed"]


class Amnesiac(Wagon):
    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.place, self.speed = arrays["place"], np.zeros_like(arrays["speed"])


class Fixed(Wagon):
    """Its number of bodies cannot change once it is opened."""

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.place[:], self.speed[:] = arrays["place"][0], arrays["speed"][0]


class Restless(Wagon):
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        return super().step(action, np.ones_like(alive))


class Whole(Wagon):
    """It restores several bodies together, but not one alone."""

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        if len(arrays["place"]) > 1:
            super().load(arrays)


class Heir(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.place[born] = words % 7
        return self.place[born]


class Intruder(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.speed += 1
        return super().reset(born, words)


class Gambler(Wagon):
    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        return super().reset(born, words + counted())


class Doubled(Wagon):
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        senses, outcome = super().step(action, alive)
        return senses.astype(float), outcome


class Stored(Wagon):
    load = HostHabitat.load


class Scored(Wagon):
    tallies = ("score",)

    def tally(self) -> np.ndarray:
        return self.place.astype(np.int32)


class Scribble(Scored):
    """It saves its counts, as it must, and its pictures are all that is wrong."""

    def save(self) -> dict[str, np.ndarray]:
        return {**super().save(), "tally": self.tally()}

    def seen(self) -> np.ndarray:
        return self.place

    def picture(self, body: Any, action: np.ndarray) -> Any:
        return "a picture"


class Miscounted(Scored):
    """It counts the ticks of all lives in a cell."""

    def open(self, cells: int, watched: bool = False) -> None:
        super().open(cells, watched)
        self.ticks = np.zeros((cells, 1), np.int32)

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        self.ticks[alive] += 1
        return super().step(action, alive)

    def tally(self) -> np.ndarray:
        return self.ticks

    def save(self) -> dict[str, np.ndarray]:
        return {**super().save(), "tally": self.ticks}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        super().load(arrays)
        self.ticks = arrays["tally"].copy()


class Eaten(Scored):
    tallies = ("food",)


class Worldly(Scored):
    tallies = ("age", "world")


class Partial(Wagon):
    def save(self) -> dict[str, np.ndarray]:
        return {"place": self.place, "speed": self.speed, "clock": np.zeros(2)}


class Divided(Wagon):
    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        senses, outcome = super().step(action, alive)
        with np.errstate(invalid="ignore"):
            return senses, outcome._replace(food=np.zeros(len(alive), np.float32) / np.float32(0))


HOST_FAULTS: list[tuple[Any, str]] = [
    (
        Amnesiac(),
        "at age 7 after `save` and `load`; save everything on which a body's future depends",
    ),
    (Fixed(), "after `save` and `load`"),
    (Restless(), "after a rest; do not step bodies whose cells are not alive"),
    (Whole(), "after `save` and `load`"),
    (Heir(), "if another lived in its cell before; let `reset` make complete bodies"),
    (Intruder(), "when others are born beside it"),
    (Gambler(), "at age 0 when it begins again, .*; draw only from `words`"),
    (Doubled(), r"gives senses from step as float64 \(32, 1\); the contract says float32"),
    (Divided(), "gives values of food that are not finite, for bodies that live on"),
    (Stored(), "defines save without load; define both, or neither"),
    (Scored(), "does not save its counts; save them as 'tally'"),
    (Scribble(), "returns str from picture; return a PIL.Image.Image"),
    (Miscounted(), "if another lived in its cell before; let `reset` make complete bodies"),
    (Eaten(), r"has tallies \['food'\], which are columns of deaths already"),
    (Worldly(), r"has tallies \['world'\], which are columns of deaths already"),
    (Partial(), r"saves 'clock' as \(2,\); save NumPy arrays with cells as first axis"),
]


@pytest.mark.parametrize(
    ("habitat", "says"),
    [*JAX_FAULTS, *HOST_FAULTS],
    ids=[type(habitat).__name__ for habitat, _ in (*JAX_FAULTS, *HOST_FAULTS)],
)
@pytest.mark.filterwarnings("ignore:Senseless is not hashed")
def test_a_habitat_with_a_fault(habitat: Any, says: str) -> None:
    with pytest.raises(ContractError, match=says):
        check_habitat(habitat)


def test_a_habitat_in_jax_with_an_action_of_several_parts_keeps_its_contract() -> None:
    """On the host, `tests.habitats.test_gymnasium_lives` has habitats that keep it. The last check of all
    is that of pictures, which finds a fault above and none in `tests.testing.test_lives`."""
    check_habitat(Pair())


class Unshared(JaxHabitat):
    """A habitat that is equal only to itself."""

    senses_size, action, words = 2, Continuous(2), 2
    reset, sense, step = Still.reset, Still.sense, Still.step


def test_the_check_warns_of_a_habitat_that_cannot_share_compiled_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The test ends the check before any life."""
    monkeypatch.setattr(checks, "Lives", Mock(side_effect=InterruptedError))
    with (
        pytest.warns(UserWarning, match="Unshared is not hashed"),
        pytest.raises(InterruptedError),
    ):
        check_habitat(Unshared())
