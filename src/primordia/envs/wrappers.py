"""Rules of survival and of foraging for any Gymnasium environment."""

from collections.abc import Callable
from typing import Any

import gymnasium
import jax.numpy as jnp
import numpy as np
from gymnasium.utils import RecordConstructorArgs
from gymnasium.wrappers import TimeLimit

from primordia.law.metabolism import (
    ONE,
    Metabolism,
    Rates,
    add,
    food_eaten,
    metabolise,
    to_fixed_point,
)

Food = Callable[[Any, float, dict[str, Any]], float]
"""Food of a tick, from the observation, the environment's reward and `info`."""


class Survival(gymnasium.Wrapper, RecordConstructorArgs):
    """An environment that rewards only survival, without a time limit."""

    def __init__(self, env: gymnasium.Env, reward: float = 0.0) -> None:
        """Wrap an environment and remove its time limit; `reward` is the reward of a tick lived."""
        RecordConstructorArgs.__init__(self, reward=reward)
        super().__init__(_without_limit(env))
        self._reward = reward

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Live one tick."""
        observation, _, died, truncated, info = self.env.step(action)
        return observation, 0.0 if died else self._reward, died, truncated, info


class Forager(gymnasium.Wrapper, RecordConstructorArgs):
    """An environment in which a body starves without food. Energy is computed as in runs.

    `info["energy"]` is the energy left. `info["food"]` is the food so far. At the end of a life
    `info["cause"]` is `starved` or `fatal`.
    """

    def __init__(
        self,
        env: gymnasium.Env,
        food: Food | None = None,
        *,
        reward: float = 0.0,
        store: float = 100.0,
        drain: float = 1.0,
        gain: float = 1.0,
        cap: float = 1e6,
    ) -> None:
        """Wrap an environment and remove its time limit.

        Args:
            env: the environment.
            food: food of a tick; by default the environment's reward.
            reward: the reward of each tick that is lived.
            store: energy at birth.
            drain: energy spent by living for one tick.
            gain: energy from one unit of food.
            cap: largest energy.
        """
        rules = {"store": store, "drain": drain, "gain": gain, "cap": cap}
        recorded: dict[str, Any] = {"food": food, "reward": reward, **rules}
        RecordConstructorArgs.__init__(self, **recorded)
        super().__init__(_without_limit(env))
        self._food, self._reward = food or _reward_of, reward
        values = Metabolism(**rules).model_dump()
        self._rates = Rates(*(jnp.float32(values[name]) for name in Metabolism.model_fields))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin a life with a full store."""
        observation, info = self.env.reset(seed=seed, options=options)
        self._energy, self._eaten = to_fixed_point(self._rates.store), jnp.int32(0)
        return observation, self._told(info)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Live one tick: eat, spend energy, and starve if none is left."""
        observation, reward, fatal, truncated, info = self.env.step(action)
        food = jnp.float32(self._food(observation, float(reward), info))
        self._energy = metabolise(self._energy, food, None, self._rates)
        self._eaten = add(self._eaten, food_eaten(food))
        starved = bool(self._energy <= 0)
        cause = {"cause": "fatal" if fatal else "starved"} if fatal or starved else {}
        died = bool(fatal) or starved
        return observation, 0.0 if died else self._reward, died, truncated, self._told(info) | cause

    def _told(self, info: dict[str, Any]) -> dict[str, Any]:
        energy, eaten = (float(np.asarray(each)) / ONE for each in (self._energy, self._eaten))
        return {**info, "energy": energy, "food": eaten}


def _reward_of(observation: Any, reward: float, info: dict[str, Any]) -> float:
    return reward


def _without_limit(env: gymnasium.Env) -> gymnasium.Env:
    """Return an environment without its time limit, if that is its outermost wrapper."""
    return env.env if isinstance(env, TimeLimit) else env
