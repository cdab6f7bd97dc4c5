"""The rules of survival and foraging around any environment, in numbers."""

from typing import Any

import numpy as np
import pytest

pytest.importorskip("gymnasium")

import gymnasium
from gymnasium import spaces
from gymnasium.wrappers import TimeLimit

from primordia.envs import Forager, Survival


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
    """Live a life. Return reward, end, cut and info of each tick."""
    results: list[tuple[Any, ...]] = []
    while len(results) < most and not (results and results[-1][1]):
        results.append(env.step(0)[1:])
    return results


def test_energy_and_food_of_every_life_follow_the_settings() -> None:
    """The store is 4; a tick costs 1.5 and brings 0.5 x 2, but no energy is above the cap of 3."""
    env = Forager(Script(), reward=0.25, store=4.0, drain=1.5, gain=2.0, cap=3.0)
    for _ in range(2):
        _, begin = env.reset(seed=5, options={"a": 1})
        assert begin == {"age": 0, "energy": 4.0, "food": 0.0}
        results = lived(env)
        energies = [3.0 - 0.5 * tick for tick in range(7)]
        assert [info["energy"] for *_, info in results] == energies
        assert [info["food"] for *_, info in results] == [0.5 * tick for tick in range(1, 8)]
        assert [reward for reward, *_ in results] == [0.25] * 6 + [0.0]
        assert [cut for _, _, cut, _ in results] == [tick == 3 for tick in range(1, 8)]
        assert [info.get("cause") for *_, info in results] == [None] * 6 + ["starved"]
        assert [info["age"] for *_, info in results] == list(range(1, 8))
    inner: Any = env.unwrapped
    assert inner.given == [(5, {"a": 1})] * 2


def test_by_default_food_is_the_reward_and_a_store_of_100_drains_by_1() -> None:
    env = Forager(Script(reward=0.0))
    assert env.reset()[1]["energy"] == 100.0
    results = lived(env, 200)
    assert len(results) == 100
    assert {reward for reward, *_ in results} == {0.0}
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


def test_food_that_is_not_finite_is_not_eaten() -> None:
    for food in (np.inf, -np.inf, np.nan):
        meals = iter([2.0, food])
        env = Forager(Script(), lambda *_, meals=meals: next(meals))
        env.reset()
        assert [info["food"] for *_, info in lived(env, 2)] == [2.0, 2.0]


@pytest.mark.parametrize(
    ("end", "cause", "ticks"), [(5, "fatal", 5), (6, "fatal", 6), (7, "starved", 6)]
)
def test_a_life_ends_with_the_environment_or_when_the_store_is_empty(
    end: int, cause: str, ticks: int
) -> None:
    env = Forager(Script(end=end), store=3.0, reward=1.0)
    env.reset()
    results = lived(env)
    assert (len(results), results[-1][-1]["cause"]) == (ticks, cause)
    assert [reward for reward, *_ in results] == [1.0] * (ticks - 1) + [0.0]


@pytest.mark.parametrize("rules", [Survival, Forager])
def test_a_time_limit_around_the_environment_is_removed(rules: Any) -> None:
    script = Script()
    assert rules(TimeLimit(script, 2)).env is script
    assert rules(script).env is script


def test_a_tick_in_which_the_environment_cuts_a_life_is_rewarded() -> None:
    """The environment cuts each life at an age of 3."""
    env = Survival(Script(end=5), reward=2.0)
    env.reset()
    results = lived(env)
    assert [reward for reward, *_ in results] == [2.0] * 4 + [0.0]
    assert [cut for _, _, cut, _ in results] == [False, False, True, False, False]


@pytest.mark.parametrize("rules", [Survival, Forager])
def test_an_environment_that_is_made_from_a_spec_has_the_rules_of_the_spec(rules: Any) -> None:
    spec = rules(gymnasium.make("CartPole-v1"), reward=2.5).spec
    again = gymnasium.make(spec)
    again.reset(seed=1)
    assert again.step(0)[1] == 2.5
    again.close()
