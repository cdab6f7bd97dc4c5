"""gymnax's Acrobot as a body that begins upright, as `acrobot.toml` beside this file needs it."""

from typing import Any

import jax.numpy as jnp
from gymnax.environments import spaces
from gymnax.environments.classic_control import acrobot


class Acrobot(acrobot.Acrobot):
    """Acrobot, which begins at the top and perceives how far it is from rest there."""

    def reset_env(self, key: Any, params: Any) -> tuple[Any, Any]:
        """Return the first observation and state: angles and velocities within 0.1 of rest."""
        _, state = super().reset_env(key, params)
        state = state.replace(joint_angle1=_wrap(state.joint_angle1 + jnp.pi))
        return self.get_obs(state), state

    def is_terminated(self, state: Any, params: Any) -> Any:
        """Return whether the tip is below the line that Acrobot-v1 has as its goal."""
        return ~super().is_terminated(state, params)

    def get_obs(self, state: Any, params: Any = None, key: Any = None) -> Any:
        """Return the angles of both joints from the upright line, and their velocities, (4,)."""
        first = _wrap(state.joint_angle1 + jnp.pi)
        return jnp.array([first, state.joint_angle2, state.velocity_1, state.velocity_2])

    def observation_space(self, params: Any) -> spaces.Box:
        """Return the bounds of the observation."""
        high = jnp.array([1.0, 2.0, params.max_vel_1, params.max_vel_2], jnp.float32)
        return spaces.Box(-high, high, (4,), jnp.float32)


def _wrap(angle: Any) -> Any:
    return acrobot.wrap(angle, -jnp.pi, jnp.pi)
