"""A small environment with the interface of gymnax: a walk in gusts, in which energy wears off."""

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np


@dataclass(frozen=True)
class Params:
    gusts: float = 0.5
    energy: int = 9
    max_steps_in_episode: int = 5


class Walk:
    """A walk along a line; the state's `gust` is what was drawn in the last tick."""

    default_params = Params()

    def reset_env(self, key: Any, params: Params) -> tuple[Any, Any]:
        place = jax.random.uniform(key, (2,), minval=-1.0, maxval=1.0)
        state = {"place": place, "gust": 0.0, "energy": params.energy, "time": 0, "tired": False}
        return self.seen(state), state

    def step_env(self, key: Any, state: Any, action: Any, params: Params) -> tuple[Any, ...]:
        gust = jax.random.uniform(key)
        place = state["place"] * 0.9 + action * params.gusts
        energy, time = state["energy"] - 1, state["time"] + 1
        state = {"place": place, "gust": gust, "energy": energy, "time": time, "tired": energy < 3}
        done = (energy <= 0) | (time >= params.max_steps_in_episode)
        return self.seen(state), state, jnp.abs(place[0]), done, {"crossed": place > 0}

    def seen(self, state: Any) -> Any:
        return jnp.concatenate([state["place"], jnp.array([state["energy"]], jnp.float32)])

    def action_space(self, params: Params) -> Any:
        return SimpleNamespace(low=-2.0, high=4.0, shape=(2,), dtype=jnp.float32)

    def observation_space(self, params: Params) -> Any:
        high = np.array([np.inf, 1.0, params.energy])
        return SimpleNamespace(low=np.array([-np.inf, -1.0, 0.0]), high=high, shape=(3,))


class Choice(Walk):
    """A walk with three choices, observed as one of four rooms."""

    def seen(self, state: Any) -> Any:
        return jnp.asarray(state["energy"]) % 4

    def step_env(self, key: Any, state: Any, action: Any, params: Params) -> tuple[Any, ...]:
        return super().step_env(key, state, jnp.float32(action), params)

    def action_space(self, params: Params) -> Any:
        return SimpleNamespace(n=3, shape=(), dtype=jnp.int32)

    def observation_space(self, params: Params) -> Any:
        return SimpleNamespace(n=4, shape=())


@dataclass(frozen=True)
class Stepped:
    """A state with the names of MuJoCo Playground's."""

    obs: Any
    reward: Any
    done: Any
    metrics: dict[str, Any]


jax.tree_util.register_dataclass(Stepped)


class Played:
    """A walk with the interface of MuJoCo Playground; its steps write into `metrics`."""

    action_size = 2

    def reset(self, key: Any) -> Stepped:
        place = jax.random.uniform(key, (2,), minval=-1.0, maxval=1.0)
        nothing = jnp.float32(0)
        return Stepped(self.seen(place), nothing, nothing, {"far": nothing})

    def step(self, state: Stepped, action: Any) -> Stepped:
        place = state.obs["state"] + action
        far = jnp.abs(place).max()
        state.metrics["far"] = far
        return Stepped(self.seen(place), far / 4, jnp.float32(far > 2.0), state.metrics)

    def seen(self, place: Any) -> Any:
        return {"state": place, "privileged_state": jnp.concatenate([place, place])}


class Mute(Walk):
    """A walk whose actions no brain can put out."""

    def action_space(self, params: Params) -> Any:
        return SimpleNamespace(spaces=[])


class Growing(Walk):
    """A walk whose state gets a further part."""

    def step_env(self, key: Any, state: Any, action: Any, params: Params) -> tuple[Any, ...]:
        seen, state, *rest = super().step_env(key, state, action, params)
        return seen, {**state, "more": 0}, *rest


class Nothing:
    """No environment."""


class Turning(Walk):
    """A walk in a hundred dimensions at once, turned by a matrix in each step."""

    def reset_env(self, key: Any, params: Params) -> tuple[Any, Any]:
        seen, state = super().reset_env(key, params)
        return seen, {**state, "wide": jax.random.normal(key, (100,))}

    def step_env(self, key: Any, state: Any, action: Any, params: Params) -> tuple[Any, ...]:
        wide = jnp.asarray(TURN) @ state["wide"] / 10 + action.sum()
        _, stepped, *rest = super().step_env(key, state, action, params)
        stepped = {**stepped, "wide": wide, "place": jnp.stack([wide.sum(), wide.mean()])}
        return self.seen(stepped), stepped, *rest


TURN = np.random.default_rng(3).normal(size=(100, 100)).astype(np.float32)


class Overwriting(Walk):
    """A walk whose steps write into the state that they are given."""

    def step_env(self, key: Any, state: Any, action: Any, params: Params) -> tuple[Any, ...]:
        state["gust"] = jnp.float32(0)
        return super().step_env(key, state, action, params)


class Undefined(Walk):
    """A walk whose third observation and reward are no numbers at last."""

    def step_env(self, key: Any, state: Any, action: Any, params: Params) -> tuple[Any, ...]:
        seen, state, _, *rest = super().step_env(key, state, action, params)
        root = jnp.sqrt(state["energy"] - 5.0)
        return seen.at[2].set(root), state, root, *rest
