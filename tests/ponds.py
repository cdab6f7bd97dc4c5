"""Gymnasium environments for tests: one of odd spaces, and one for each thing that can be wrong."""

import os
import random
from itertools import count
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from primordia.habitats.gymnasium.simulator import Environments, fields
from primordia.habitats.gymnasium.spaces import Acting, Observation

NUMBERS = count()
"""State of the module, which a reset does not restore."""
CRASH = 5
"""The age at which a crashing pond raises an error."""


class Pond(gymnasium.Env):
    """A fish that swims along a line; it dies at the edge."""

    observation_space: Any = spaces.Box(-10, 10, (2,), np.float64)
    action_space: Any = spaces.Box(-1, 1, (1,), np.float32)
    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}  # noqa: RUF012

    def __init__(self, edge: float = 3.0, render_mode: str | None = None) -> None:
        self.edge, self.render_mode = edge, render_mode
        self.resets = 0

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        super().reset(seed=seed)
        self.place = np.array([self.np_random.uniform(-1, 1), 0.0])
        self.age = 0
        self.resets += 1
        return self.observed(), {"age": 0}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.age += 1
        self.place[1] = 0.9 * self.place[1] + 0.1 * float(np.ravel(action)[0])
        self.place[0] += self.place[1] + 0.2 * self.np_random.normal()
        left = bool(abs(self.place[0]) > self.edge)
        return self.observed(), float(self.place[1]), left, False, {"age": self.age, "word": "no"}

    def observed(self) -> Any:
        return self.place.copy()

    def render(self) -> np.ndarray:
        picture = np.full((30, 40, 3), 255, np.uint8)
        picture[:, int(np.clip(20 + 5 * self.place[0], 0, 39))] = 0
        return picture


class Odd(Pond):
    """A pond with every kind of space that can be used, on both sides."""

    observation_space: Any = spaces.Dict(
        {
            "where": spaces.Box(-10, 10, (2, 1), np.float64),
            "free": spaces.Box(-np.inf, np.inf, (1,), np.float64),
            "side": spaces.Discrete(3, start=-1),
            "both": spaces.Tuple([spaces.MultiDiscrete([2, 4]), spaces.MultiBinary(3)]),
        }
    )
    action_space: Any = spaces.Tuple(
        [
            spaces.Box(np.array([-2.0, 0.0]), np.array([2.0, np.inf]), dtype=np.float64),
            spaces.Dict(
                {"gear": spaces.MultiDiscrete([2, 3], start=[1, -1]), "fins": spaces.MultiBinary(2)}
            ),
            spaces.Discrete(4, start=7),
        ]
    )  # fmt: skip

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        assert self.action_space.contains(action), action
        (push, _), own, gear = action
        return super().step(np.array([push / 2 * (gear - 6) / 4 * own["gear"][0]]))

    def observed(self) -> Any:
        x = self.place[0]
        return {
            "where": self.place.reshape(2, 1).copy(),
            "free": np.array([100 * x]),
            "side": np.int64(np.sign(x)),
            "both": (np.array([x > 0, min(3, self.age)]), np.array([1, 0, x > 1], np.int8)),
        }


class Unseeded(Pond):
    """A reset that ignores its seed."""

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        return super().reset(seed=next(NUMBERS))


class Hidden(Pond):
    """A step that depends on the state of the module."""

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.place[1] += 1e-9 * next(NUMBERS)
        return super().step(action)


class Shared(Pond):
    """A generator that all ponds share; each reset seeds it, so one pond alone repeats its lives."""

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        random.seed(seed)
        return super().reset(seed=seed)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.place[1] += 1e-9 * random.random()
        return super().step(action)


class Worn(Pond):
    """A reset that does not restore all."""

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.place[1] += 1e-9 * self.resets
        return super().step(action)


class Grasping(Pond):
    """A step that changes its argument."""

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        found = super().step(action)
        action *= 0
        return found


class Outside(Pond):
    """An observation outside the declared space."""

    def observed(self) -> Any:
        return self.place + 20


class Broken(Pond):
    """An observation that is no number."""

    def observed(self) -> Any:
        return np.array([self.place[0], np.nan if self.age > 2 else 0])


class Crashing(Pond):
    """An environment that prints, and raises an error at an age where the fish is on the right."""

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        print("splash")
        found = super().step(action)
        if self.age == CRASH and self.place[0] > 0:
            raise ZeroDivisionError("the pond\nis empty")
        return found


class Splashing(Pond):
    """An environment that writes to standard output, as C libraries do."""

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        os.write(1, b"splash\n")
        return super().step(action)


class Spoiled(Crashing):
    """A crashing environment that fails at each reset after an error."""

    spoiled = False

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        if self.spoiled:
            raise RuntimeError("the pond is spoiled")
        return super().reset(seed=seed)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.spoiled = True
        found = super().step(action)
        self.spoiled = False
        return found


class Unborn(Pond):
    """An environment whose reset raises an error for some seeds."""

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        if seed is not None and seed % 4 == 1:
            raise RuntimeError("no water")
        return super().reset(seed=seed)


class Talking(Pond):
    """An observation that is text."""

    observation_space: Any = spaces.Dict({"where": Pond.observation_space, "says": spaces.Text(9)})


class Still(Pond):
    """An action space without a choice."""

    action_space: Any = spaces.Discrete(1)


class Closed(Pond):
    """Holds something that is not plain data, though lives repeat."""

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        self.draws = iter(range(10**6))
        return super().reset(seed=seed)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.place[1] += 1e-9 * next(self.draws)
        return super().step(action)


class Sealed(Pond):
    """A pond that counts its steps in a closure, outside its state. The count matters at one age."""

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        steps = iter(range(10**6))
        self.count = lambda: next(steps)
        return super().reset(seed=seed)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        counted = self.count()
        if self.age == 6:
            self.place[1] += 1e-9 * counted
        return super().step(action)


def food(observation: Any, reward: Any, terminated: Any, truncated: Any, info: Any) -> float:
    return 2.0 * info["age"]


KINDS = (
    Pond, Odd, Unseeded, Hidden, Shared, Worn, Grasping, Outside, Broken, Crashing, Spoiled, Splashing,
    Unborn, Talking, Still, Closed, Sealed,
)  # fmt: skip
for kind in KINDS:
    gymnasium.register(
        f"{kind.__name__}-v0", entry_point=f"tests.ponds:{kind.__name__}", max_episode_steps=50
    )


def environments(
    kind: str = "Pond", food: str = "", saving: str = "replay", **info: int
) -> tuple[Environments, dict[str, np.ndarray]]:
    """Return ponds in two cells of this process, and the arrays that they fill."""
    shared = fields(Observation(Pond.observation_space), Acting(Pond.action_space), info)
    arrays = {name: np.zeros((2, *shape), dtype) for name, (dtype, shape) in shared.items()}
    made = Environments(arrays, f"tests.ponds:{kind}-v0", {}, saving, False, food, info)
    for cell in range(2):
        made.make(cell)
    return made, arrays


def lived(made: Any, arrays: dict[str, np.ndarray], word: int, ticks: int) -> None:
    """Begin a life in the first cell with a word, and live some ticks."""
    arrays["seed"][0] = word
    made.reset(0)
    for tick in range(ticks):
        arrays["action"][0] = tick / 8
        made.step([0])


def noted_seeds(monkeypatch: Any) -> list[int]:
    """Return the seeds with which ponds are reset from now on."""
    seeds, reset = list[int](), Pond.reset

    def noting(self: Pond, *, seed: int, options: Any = None) -> Any:
        seeds.append(seed)
        return reset(self, seed=seed, options=options)

    monkeypatch.setattr(Pond, "reset", noting)
    return seeds
