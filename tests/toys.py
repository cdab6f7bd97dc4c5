"""Habitats and brains for tests, so simple that one can say what must happen."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jax import Array, lax
from pydantic import Field

from primordia.brains.contract import Brain, Genome
from primordia.brains.layout import Shape
from primordia.brains.recurrent import Recurrent
from primordia.habitats import Compound, Continuous, Discrete, HostHabitat, JaxHabitat, Outcome
from primordia.habitats.cartpole.habitat import COORDINATES, CartPole
from primordia.habitats.on_host import OnHost
from primordia.settings.base import Settings


class Meadow(JaxHabitat, Settings):
    """A habitat in which nothing moves. Food and effort are constant; bodies die at a given age."""

    lifespan: int = 2**30
    food: float = 0.0
    effort: float = 0.0
    broken_at: int = 2**30
    """the age at which a body becomes NaN"""

    senses_size: int = 2
    action: Any = Discrete(2)
    words: int = 1

    def reset(self, words: Array) -> Array:
        return jnp.zeros((len(words), 2), jnp.float32)

    def sense(self, bodies: Array) -> Array:
        return jnp.ones_like(bodies)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        clock = bodies[:, 0] + 1
        broken = jnp.where(clock >= self.broken_at, jnp.nan, 0.0)
        same = jnp.ones(len(bodies), jnp.float32)
        outcome = Outcome(clock >= self.lifespan, same * self.food, same * self.effort)
        return jnp.stack([clock, broken], axis=1), outcome


class Mill(JaxHabitat, Settings):
    """A wheel that a continuous action turns. Food is the turn; the wheel breaks at some angles."""

    senses_size: int = 3
    action: Any = Continuous(2)
    words: int = 2

    def reset(self, words: Array) -> Array:
        return (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)

    def sense(self, bodies: Array) -> Array:
        return jnp.concatenate([bodies, bodies[:, :1] * bodies[:, 1:]], axis=1)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        turn = jnp.clip(action[:, 0], -1, 1)
        angle = jnp.sin(bodies[:, 0] + turn)
        after = jnp.stack([angle, jnp.cos(bodies[:, 1] + action[:, 1])], axis=1)
        return after, Outcome(angle > 0.999, food=turn, effort=jnp.abs(action[:, 1]))


class Slope(JaxHabitat, Settings):
    """Bodies that start at a sum of products between two bounds, and stay there."""

    senses_size: int = 2
    action: Any = Discrete(2)
    words: int = 2

    def reset(self, words: Array) -> Array:
        share = (words >> np.uint32(8)).astype(jnp.float32) * np.float32(2**-24)
        return np.float32(0.1) + share * np.float32(0.3) * (np.float32(1.1) + share[:, ::-1])

    def sense(self, bodies: Array) -> Array:
        return bodies

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies, Outcome(jnp.zeros(len(bodies), bool))


class Echo(JaxHabitat, Settings):
    """Food and effort are the two numbers of the action; at a given age food is infinite."""

    rotten_at: int = 2**30
    senses_size: int = 1
    action: Any = Continuous(2)
    words: int = 1

    def reset(self, words: Array) -> Array:
        return jnp.zeros(len(words), jnp.int32)

    def sense(self, bodies: Array) -> Array:
        return jnp.ones((len(bodies), 1), jnp.float32)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        clock = bodies + 1
        food = jnp.where(clock >= self.rotten_at, jnp.inf, action[:, 0])
        return clock, Outcome(jnp.zeros_like(clock, bool), food, action[:, 1])


class Watch(JaxHabitat, Settings):
    """Bodies that perceive their age. Food is the number of the action."""

    senses_size: int = 2
    action: Any = Continuous(1)
    words: int = 0

    def reset(self, words: Array) -> Array:
        return jnp.ones(len(words), jnp.float32)

    def sense(self, bodies: Array) -> Array:
        return jnp.stack([bodies, jnp.ones_like(bodies)], axis=1)

    def step(self, bodies: Array, action: Array) -> tuple[Array, Outcome]:
        return bodies + 1, Outcome(jnp.zeros_like(bodies, bool), action[:, 0])


class Mirror(OnHost):
    """A JAX habitat on the host. Its bodies are stored under a name that enters old digests."""

    def __init__(self, inner: str = "cartpole", **options: Any) -> None:
        kinds = {"cartpole": CartPole, "mill": Mill, "meadow": Meadow, "watch": Watch}
        super().__init__(kinds[inner](**options))

    def save(self) -> dict[str, np.ndarray]:
        return {"mirror": super().save()["body0"]}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        super().load({"body0": arrays["mirror"]})


class Clocked(Mirror):
    """A habitat that tallies the ticks lived, up and down; its senses of unstepped bodies are 9."""

    counted: tuple[str, ...] = "ticks", "ticks_down"

    def __init__(self, inner: str = "cartpole", **options: Any) -> None:
        super().__init__(inner, **options)
        self.tallies = self.counted

    def open(self, cells: int, watched: bool = False) -> None:
        super().open(cells)
        self.clock = np.zeros(cells, np.int32)

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.clock[born] = 0
        return super().reset(born, words)

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        self.clock += alive
        senses, outcome = super().step(action, alive)
        senses[~alive] = 9.0
        return senses, outcome

    def tally(self) -> np.ndarray:
        return np.stack([self.clock, -self.clock], axis=1)

    def save(self) -> dict[str, np.ndarray]:
        return {**super().save(), "tally": self.tally()}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        super().load(arrays)
        self.clock = np.array(arrays["tally"][:, 0])


class HostCartPole(HostHabitat):
    """CartPole in plain NumPy: float64, with a loop over cells, as users write simulators."""

    senses_size, action, words = 4, Discrete(2), len(COORDINATES)

    def open(self, cells: int, watched: bool = False) -> None:
        self.state = np.zeros((cells, 4))

    def reset(self, born: np.ndarray, words: np.ndarray) -> np.ndarray:
        self.state[born] = words / 2**32 * 0.1 - 0.05
        return self.state[born].astype(np.float32)

    def step(self, action: np.ndarray, alive: np.ndarray) -> tuple[np.ndarray, Outcome]:
        for cell in np.flatnonzero(alive):
            self.state[cell] = self._stepped(10.0 if action[cell] else -10.0, *self.state[cell])
        fatal = (np.abs(self.state[:, 0]) > 2.4) | (np.abs(self.state[:, 2]) > np.deg2rad(12))
        return self.state.astype(np.float32), Outcome(fatal)

    def _stepped(self, push: float, x: float, x_dot: float, theta: float, theta_dot: float) -> list:
        cos, sin = np.cos(theta), np.sin(theta)
        temp = (push + 0.05 * theta_dot**2 * sin) / 1.1
        theta_acc = (9.8 * sin - cos * temp) / (0.5 * (4.0 / 3.0 - 0.1 * cos**2 / 1.1))
        x_acc = temp - 0.05 * theta_acc * cos / 1.1
        return [x + 0.02 * x_dot, x_dot + 0.02 * x_acc,
                theta + 0.02 * theta_dot, theta_dot + 0.02 * theta_acc]  # fmt: skip

    def save(self) -> dict[str, np.ndarray]:
        return {"cartpole": self.state}

    def load(self, arrays: dict[str, np.ndarray]) -> None:
        self.state = np.array(arrays["cartpole"])


HOST_CARTPOLE = {"name": "tests.toys:HostCartPole"}


class Sliding(Brain):
    """A brain whose kernels slide over the change of the senses; its blocks have any rank and name."""

    width: int = Field(2, ge=1)
    channels: int = Field(3, ge=1)

    def blocks(self, senses: int, outputs: int) -> dict[str, Shape]:
        places = senses - self.width + 1
        tensor = outputs, self.channels, places
        return {"slide-2": (self.channels, self.width), "OUT_3d": tensor, "0": (outputs,)}

    def memory(self, senses: int, outputs: int) -> int:
        return senses

    def __call__(self, genome: Genome, memory: Array, senses: Array) -> tuple[Array, Array]:
        places, change = senses.shape[1] - self.width + 1, senses - memory
        windows = jnp.stack([change[:, i : i + self.width] for i in range(places)], axis=1)
        features = jnp.tanh(_dot(genome["slide-2"], windows, (2,), (2,)))
        return senses, _dot(genome["OUT_3d"], features, (2, 3), (1, 2)) + genome["0"]


class Twin(Recurrent):
    """A brain of another name whose genomes have the blocks of Recurrent."""


def _dot(a: Array, b: Array, of_a: tuple[int, ...], of_b: tuple[int, ...]) -> Array:
    """Return the products of each organism's a and b, summed over axes of both."""
    return lax.dot_general(a, b, ((of_a, of_b), ((0,), (0,))), precision=lax.Precision.HIGHEST)


class Organ(Mill):
    """A mill with a brake beside its wheel, and a time limit after which bodies expire."""

    limit: int = 2**30
    action: Any = Compound((Discrete(3), Continuous(2)))

    def reset(self, words: Array) -> Any:
        return super().reset(words), jnp.zeros(len(words), jnp.int32)

    def sense(self, bodies: Any) -> Array:
        return super().sense(bodies[0])

    def step(self, bodies: Any, action: Array) -> tuple[Any, Outcome]:
        released = (action[:, :1] != 1).astype(jnp.float32)
        wheel, outcome = super().step(bodies[0], action[:, 1:] * released)
        clock = bodies[1] + 1
        return (wheel, clock), outcome._replace(expired=clock >= self.limit)
