"""Environments as pure functions of one body: reset and step, without automatic resets.

An environment has the interface of gymnax: `default_params`, `reset_env(key, params)`,
`step_env(key, state, action, params)`, `action_space(params)` and `observation_space(params)`.
"""

import dataclasses
import json
import re
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import is_dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia import device
from primordia.habitats.gymnax import libraries
from primordia.habitats.gymnax.libraries import NEVER
from primordia.settings.tables import did_you_mean

TIME_LIMITS = ("max_steps_in_episode", "max_timesteps")
"""Parameters that are time limits: the number of steps after which an environment ends."""
ADDRESS = re.compile("0x[0-9a-f]+")
"""A pattern for addresses in memory, which JAX prints for some functions."""


MINATAR = ("noop", "left", "up", "right", "down", "fire")
"""Names of the actions of MinAtar (Young & Tian 2019, "n l u r d f"), by their numbers."""


class Step(NamedTuple):
    """The result of a tick for a body."""

    observation: Any
    state: Any
    reward: Array
    """float32 ()"""
    done: Array
    """bool (): the environment has ended; its time limit counts only if `Simulator.time_limit` is true"""
    info: Any


class Simulator:
    """One environment with its parameters. Each function is for one body and can be mapped over many."""

    def __init__(self, env: Any, params: Any, time_limit: bool) -> None:
        self.env, self.params = env, params
        self._truncates = time_limit and hasattr(env, "is_truncated")

    @property
    def limits(self) -> list[str]:
        """The parameters that are the environment's own time limits."""
        return [each for each in TIME_LIMITS if hasattr(self.params, each)]

    @property
    def action_space(self) -> Any:
        """The space of actions."""
        with jax.ensure_compile_time_eval():
            return self.env.action_space(self.params)

    @property
    def observation_space(self) -> Any:
        """The space of observations; None if the environment does not state it."""
        try:
            with jax.ensure_compile_time_eval():
                return self.env.observation_space(self.params)
        except (AttributeError, NotImplementedError):
            return None

    @property
    def buttons(self) -> tuple[str, ...] | None:
        """The names of the choices, if the environment is a game of MinAtar; otherwise None."""
        numbers = getattr(self.env, "action_set", None)
        if numbers is None or "MinAtar" not in str(getattr(self.env, "name", "")):
            return None
        return tuple(MINATAR[number] for number in np.asarray(numbers).tolist())

    def reset(self, key: Array) -> tuple[Any, Any]:
        """Return the first observation and state for a key uint32 (2,)."""
        observation, state = self.env.reset_env(key, self.params)
        return observation, self._typed(state)

    @property
    def amounts(self) -> dict[str, Any]:
        """The parameters that are floats or arrays of floats, except time limits."""
        fields = dataclasses.fields(self.params) if is_dataclass(self.params) else ()
        values = {each.name: getattr(self.params, each.name) for each in fields}
        return {
            name: value
            for name, value in values.items()
            if isinstance(value, float | np.ndarray | jax.Array)
            and jnp.issubdtype(jnp.result_type(value), jnp.floating)
            and name not in TIME_LIMITS
        }

    def step(
        self, key: Array, state: Any, action: Array, amounts: Mapping[str, Array] | None = None
    ) -> Step:
        """Return the result of a tick for a key uint32 (2,) and an action of the environment's space.

        Args:
            key: uint32 (2,).
            state: the state before the tick.
            action: an action of the environment's space.
            amounts: other values of some parameters in this tick, by name.
        """
        params = dataclasses.replace(self.params, **amounts) if amounts else self.params
        observation, state, reward, done, info = self._step(key, state, action, params)
        if self._truncates:
            done = jnp.asarray(done) | self.env.is_truncated(state, params)
        reward, done = jnp.asarray(reward, jnp.float32), jnp.asarray(done, bool)
        return Step(observation, self._typed(state), reward, done, info)

    @cached_property
    def example(self) -> Step:
        """Shapes and types of the results of `step`."""
        with traced():
            return jax.eval_shape(self.step, KEY, self._state, self._action)

    @property
    def _action(self) -> jax.ShapeDtypeStruct:
        space = self.action_space
        return jax.ShapeDtypeStruct(getattr(space, "shape", ()), getattr(space, "dtype", jnp.int32))

    @cached_property
    def _state(self) -> Any:
        """Shapes of the state, and types that hold it both at birth and later."""
        with traced():
            born = jax.eval_shape(lambda key: self.env.reset_env(key, self.params), KEY)[1]
            later = jax.eval_shape(self._step, KEY, born, self._action)[1]
        trees: list[Any] = [jax.tree.structure(each) for each in (born, later)]
        if trees[0] != trees[1] or any(
            a.shape != b.shape for a, b in zip(*map(jax.tree.leaves, (born, later)), strict=True)
        ):
            raise ValueError("env: the state has one form after a reset and another after a step")
        if any(jnp.issubdtype(each.dtype, jax.dtypes.extended) for each in jax.tree.leaves(born)):
            raise ValueError(
                "env: the state holds a key of jax.random.key; make it with jax.random.PRNGKey"
            )
        return jax.tree.map(
            lambda a, b: jax.ShapeDtypeStruct(a.shape, jnp.promote_types(a.dtype, b.dtype)),
            born,
            later,
        )

    def _step(
        self, key: Any, state: Any, action: Any, params: Any = None
    ) -> tuple[Any, Any, Any, Any, Any]:
        return self.env.step_env(key, state, action, self.params if params is None else params)

    def repeats(self) -> bool:
        """Return whether the environment's functions are the same when JAX traces them again."""
        before = self._traced()
        jax.clear_caches()
        return self._traced() == before

    def _traced(self) -> tuple[str, list[bytes]]:
        def both(key: Any, state: Any, action: Any) -> Any:
            return self.env.reset_env(key, self.params), self._step(key, state, action)

        with traced():
            found = jax.make_jaxpr(both)(KEY, self._state, self._action)
        return ADDRESS.sub("", str(found)), [np.asarray(each).tobytes() for each in found.consts]

    def changes_state(self) -> bool:
        """Return whether a step changes the state that it is given."""
        held: list[list[Any]] = []

        def step(key: Any, state: Any, action: Any) -> Any:
            held.append(jax.tree.leaves(state))
            stepped = self._step(key, state, action)
            held.append(jax.tree.leaves(state))
            return stepped

        with traced():
            jax.eval_shape(step, KEY, self._state, self._action)
        before, after = held
        return len(before) != len(after) or any(
            a is not b for a, b in zip(before, after, strict=True)
        )

    def _typed(self, state: Any) -> Any:
        return jax.tree.map(lambda a, to: jnp.asarray(a).astype(to.dtype), state, self._state)


KEY = jax.ShapeDtypeStruct((2,), jnp.uint32)


@contextmanager
def traced() -> Iterator[None]:
    """Suppress warnings, and let JAX make and split keys in one way, whatever the user has set."""
    with (
        jax.threefry_partitionable(True),
        jax.default_prng_impl("threefry2x32"),
        warnings.catch_warnings(),
    ):
        warnings.simplefilter("ignore")
        yield


@lru_cache(maxsize=64)
def simulator(name: str, params: str, time_limit: bool) -> Simulator:
    """Return the environment with this name, with some parameters replaced; `params` is JSON.

    Raises:
        ValueError: there is no such environment or parameter, or its library is not installed.
    """
    device.prepare()
    with traced():
        env = libraries.make(name, time_limit)
    return Simulator(env, _params(env, name, json.loads(params), time_limit), time_limit)


def _params(env: Any, name: str, changed: dict[str, Any], time_limit: bool) -> Any:
    """Return the parameters after replacements, and without a time limit unless `time_limit` is true."""
    params = env.default_params
    known = [each.name for each in dataclasses.fields(params)] if is_dataclass(params) else []
    for each in changed:
        if each not in known:
            raise ValueError(f"params: {name} has no parameter {each!r}{did_you_mean(each, known)}")
    # Steps of gymnax's own environments never end by time, but some observations include the time.
    if not time_limit and not type(env).__module__.startswith("gymnax."):
        changed = {**dict.fromkeys(set(TIME_LIMITS) & set(known), NEVER), **changed}
    typed = {each: _as(getattr(params, each), value, each) for each, value in changed.items()}
    return dataclasses.replace(params, **typed) if typed else params


def _as(default: Any, value: Any, name: str) -> Any:
    """Return a value of a parameter in the type of its default."""
    if isinstance(default, float) and type(value) is int:
        return float(value)
    if isinstance(default, list | tuple) and isinstance(value, list):
        return type(default)(value)
    if isinstance(default, jax.Array):
        array = jnp.asarray(value, default.dtype)
        if array.shape == default.shape:
            return array
    elif type(value) is type(default):
        return value
    raise ValueError(
        f"params: {name} is {value!r}; it must have the type and shape of its default, {default!r}"
    )
