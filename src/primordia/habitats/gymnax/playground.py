"""Tasks with the interface of MuJoCo Playground: `reset(key)` and `step(state, action)`, without a key.

MJX computes many of these tasks. MJX is made for GPUs: on a CPU a cheetah's body takes 8 ms a step.
"""

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

MEMBERS = ("reset", "step", "action_size")
PERCEIVED = "state"
"""The part of an observation for the policy, if other parts are only for training."""


def is_playground(env: Any) -> bool:
    """Return whether an environment has this interface, and not that of gymnax."""
    return not hasattr(env, "reset_env") and all(hasattr(env, each) for each in MEMBERS)


class Playground:
    """A task with the interface of gymnax."""

    default_params = SimpleNamespace()

    def __init__(self, env: Any) -> None:
        self.env = env

    def reset_env(self, key: Array, params: Any) -> tuple[Any, Any]:
        """Return the first observation and state."""
        state = self.env.reset(key)
        return _perceived(state.obs), state

    def step_env(self, key: Array, state: Any, action: Array, params: Any) -> tuple[Any, ...]:
        """Return observation, state, reward, whether the task is done, and `metrics` as info."""
        copied = jax.tree.map(lambda leaf: leaf, state)  # tasks write into its `metrics`
        state = self.env.step(copied, action)
        return _perceived(state.obs), state, state.reward, state.done > 0, state.metrics

    def action_space(self, params: Any) -> Any:
        """Return the box of actions."""
        return SimpleNamespace(low=-1.0, high=1.0, shape=(self.env.action_size,), dtype=jnp.float32)


def _perceived(observation: Any) -> Any:
    if isinstance(observation, Mapping) and PERCEIVED in observation:
        return observation[PERCEIVED]
    return observation
