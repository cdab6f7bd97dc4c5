"""The rules of survival and foraging for any environment, in figures, and the spaces of bodies."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

import gymnasium
from gymnasium import spaces
from gymnasium.wrappers import TimeLimit

from primordia.envs import Forager, LifeVectorEnv, Survival, vector
from primordia.envs.bodies import Births, Bodies, action_space, observation_space
from primordia.habitats.contract import Compound, Continuous, Discrete
from primordia.law.world import Cause
from tests.worlds import MEADOW, config


class Script(gymnasium.Env):
    """An environment with the same reward in every tick, whose lives end at an age."""

    observation_space = spaces.Box(-1, 1, (1,), np.float32)
    action_space = spaces.Discrete(2)

    def __init__(self, reward: float = 0.5, end: int = 10**9) -> None:
        self.reward, self.end, self.given = reward, end, list[Any]()

    def reset(self, *, seed: int | None = None, options: Any = None) -> tuple[Any, dict]:
        self.age = 0
        self.given.append((seed, options))
        return np.zeros(1, np.float32), {"age": 0}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict]:
        self.age += 1
        senses = np.full(1, self.age / 64, np.float32)
        return senses, self.reward, self.age == self.end, self.age == 3, {"age": self.age}


def lived(env: gymnasium.Env, most: int = 100) -> list[tuple[Any, ...]]:
    """Live a life; return reward, whether it ended, whether it was cut, and info of each tick."""
    told: list[tuple[Any, ...]] = []
    while len(told) < most and not (told and told[-1][1]):
        told.append(env.step(0)[1:])
    return told


def test_energy_and_food_of_every_life_follow_the_settings() -> None:
    """The store is 4; a tick costs 1.5 and brings 0.5 x 2, but no energy is above the cap of 3."""
    env = Forager(Script(), reward=0.25, store=4.0, drain=1.5, gain=2.0, cap=3.0)
    for _ in range(2):
        _, begin = env.reset(seed=5, options={"a": 1})
        assert begin == {"age": 0, "energy": 4.0, "food": 0.0}
        told = lived(env)
        energies = [3.0 - 0.5 * tick for tick in range(7)]
        assert [info["energy"] for *_, info in told] == energies
        assert [info["food"] for *_, info in told] == [0.5 * tick for tick in range(1, 8)]
        assert [reward for reward, *_ in told] == [0.25] * 6 + [0.0]
        assert [cut for _, _, cut, _ in told] == [tick == 3 for tick in range(1, 8)]
        assert [info.get("cause") for *_, info in told] == [None] * 6 + ["starved"]
        assert [info["age"] for *_, info in told] == list(range(1, 8))
    inner: Any = env.unwrapped
    assert inner.given == [(5, {"a": 1})] * 2


def test_by_default_food_is_the_reward_and_a_store_of_100_drains_by_1() -> None:
    env = Forager(Script(reward=0.0))
    assert env.reset()[1]["energy"] == 100.0
    told = lived(env, 200)
    assert len(told) == 100
    assert {reward for reward, *_ in told} == {0.0}
    env = Forager(Script(reward=2.0), cap=110.0)
    env.reset()
    energies = [info["energy"] for *_, info in lived(env, 12)]
    assert energies == [*range(101, 111), 110, 110]


def test_food_is_measured_from_observation_reward_and_info() -> None:
    env = Forager(
        Script(reward=8.0), lambda seen, reward, info: 64 * seen[0] + reward + info["age"]
    )
    env.reset()
    assert [info["food"] for *_, info in lived(env, 3)] == [10.0, 22.0, 36.0]


@pytest.mark.parametrize(
    ("end", "cause", "ticks"), [(5, "fatal", 5), (6, "fatal", 6), (7, "starved", 6)]
)
def test_a_life_ends_with_the_environment_or_when_the_store_is_empty(
    end: int, cause: str, ticks: int
) -> None:
    env = Forager(Script(end=end), store=3.0, reward=1.0)
    env.reset()
    told = lived(env)
    assert (len(told), told[-1][-1]["cause"]) == (ticks, cause)
    assert [reward for reward, *_ in told] == [1.0] * (ticks - 1) + [0.0]


@pytest.mark.parametrize("rules", [Survival, Forager])
def test_only_a_time_limit_that_wraps_the_environment_is_removed(rules: Any) -> None:
    script = Script()
    assert rules(TimeLimit(script, 2)).env is script
    assert rules(script).env is script


def test_each_life_of_a_body_begins_with_a_full_store_and_without_food() -> None:
    """Bodies of a meadow gain 0.5 x 2 - 3 of energy in a tick. The dead neither eat nor starve."""
    habitat, hunger = {**MEADOW["habitat"], "food": 0.5}, {"store": 9.0, "drain": 3.0, "gain": 2.0}
    bodies = Bodies(config({**MEADOW, "habitat": habitat}, metabolism=hunger), 4)

    def begin(*cells: int) -> None:
        numbers = np.array(cells, int)
        bodies.begin(numbers, Births(0 * numbers, 0 * numbers, numbers))

    def told() -> list[list[float]]:
        assert bodies.energy is not None
        return [bodies.energy.tolist(), bodies.food.tolist()]

    begin(0, 1, 2, 3)
    assert told() == [[9] * 4, [0] * 4]
    for alive in ([True] * 4, [True, False, True, True], [True, False, True, True]):
        bodies.step(np.zeros(4, np.int32), np.array(alive))
    assert told() == [[3, 7, 3, 3], [1.5, 0.5, 1.5, 1.5]]
    begin()
    begin(1, 2, 3)
    assert told() == [[3, 9, 9, 9], [1.5, 0, 0, 0]]
    causes = [bodies.step(np.zeros(4, np.int32), np.ones(4, bool)).tolist() for _ in range(2)]
    assert causes == [[-1] * 4, [Cause.STARVED, -1, -1, -1]]
    assert told() == [[-1, 5, 5, 5], [2.5, 1, 1, 1]]
    bodies.close()


def test_a_vector_has_at_most_2_to_the_24_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    """So many are not made here."""

    def make(config: Any, count: int) -> None:
        raise MemoryError(count)

    monkeypatch.setattr(vector, "Bodies", make)
    with pytest.raises(MemoryError, match=str(2**24)):
        LifeVectorEnv("CartPole-survival", 2**24)
    with pytest.raises(ValueError, match="num_envs"):
        LifeVectorEnv("CartPole-survival", 2**24 + 1)


SPACES: list[tuple[Any, spaces.Space]] = [
    (Discrete(3), spaces.Discrete(3)),
    (Continuous(2), spaces.Box(-np.inf, np.inf, (2,), np.float32)),
    (
        Continuous(2, ((-1.0, 0.0), (2.0, np.inf))),
        spaces.Box(np.float32([-1, 0]), np.float32([2, np.inf])),
    ),
    (
        Compound((Discrete(2), Continuous(1, ((-3.0,), (4.0,))))),
        spaces.Tuple([spaces.Discrete(2), spaces.Box(-3, 4, (1,), np.float32)]),
    ),
]


@pytest.mark.parametrize(("action", "space"), SPACES)
def test_spaces_are_those_of_the_habitat(action: Any, space: spaces.Space) -> None:
    bodies: Any = SimpleNamespace(habitat=SimpleNamespace(action=action, senses_size=5))
    assert action_space(bodies) == space
    assert observation_space(bodies) == spaces.Box(-np.inf, np.inf, (5,), np.float32)
