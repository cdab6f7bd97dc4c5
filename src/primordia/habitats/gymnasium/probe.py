"""The description of an environment before a run: spaces, info, time limit and pictures."""

import json
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from primordia.habitats.gymnasium import environment
from primordia.habitats.gymnasium.spaces import Acting, Observation
from primordia.habitats.silence import quiet

TICKS = 200
"""Random steps in which keys of `info` are looked for."""
LONGEST = 64
"""Settings can name a value of `info` only if it has at most this many numbers."""


PICTURES_S = 30.0
"""Default number of steps a second if an environment has pictures."""


class Probe(NamedTuple):
    """An environment's description."""

    observation: Observation
    acting: Acting
    limit: int | None
    """its registered time limit in steps"""
    rate: float | None
    """steps in a second, as the environment states"""
    pictures: bool
    """whether the environment states that it can draw"""


def probe(env: str, options: Mapping[str, Any]) -> Probe:
    """Return the description of an environment.

    Raises:
        ValueError: the environment cannot be made, perceived or acted upon; the message says why.
    """
    return _probe(env, json.dumps(options, sort_keys=True))


@lru_cache(maxsize=64)
def _probe(env: str, options: str) -> Probe:
    made = environment.make(env, json.loads(options))
    try:
        observation, acting = Observation(made.observation_space), Acting(made.action_space)
    except (AttributeError, ValueError) as error:
        raise ValueError(f"env: {env}: {error}") from None
    rate = made.metadata.get("render_fps")
    draws = environment.PICTURES in (made.metadata.get("render_modes") or ())
    found = Probe(
        observation,
        acting,
        environment.spec(env).max_episode_steps,
        float(rate)
        if isinstance(rate, int | float) and rate > 0
        else PICTURES_S
        if draws
        else None,
        draws,
    )
    made.close()
    return found


def info_of(env: str, options: Mapping[str, Any]) -> dict[str, int]:
    """Return the keys of an environment's `info` whose values are numbers, and how many numbers
    each value has.

    The keys are those that appear at a reset and in random play.
    """
    return dict(_info(env, json.dumps(options, sort_keys=True)))


@lru_cache(maxsize=64)
def _info(env: str, options: str) -> dict[str, int]:
    found: dict[str, int] = {}
    for _, info in random_play(env, json.loads(options)):
        found |= _numbers(info)
    return found


def random_play(env: str, options: Mapping[str, Any]) -> list[tuple[np.ndarray, Mapping[str, Any]]]:
    """Return observation and info of each reset and each of TICKS random steps; an error ends a life."""
    made = environment.make(env, options)
    observation = Observation(made.observation_space)
    seen: list[tuple[np.ndarray, Mapping[str, Any]]] = []

    def note(given: Any, info: Mapping[str, Any]) -> None:
        seen.append((np.zeros(observation.width), dict(info)))
        observation.fill(seen[-1][0], given)

    with quiet():
        made.action_space.seed(0)
        over = True
        for tick in range(TICKS):
            try:
                if over:
                    note(*made.reset(seed=tick))
                given, _, terminated, truncated, info = made.step(made.action_space.sample())
                over = terminated or truncated
                note(given, info)
            except Exception:  # `check` reports it
                over = True
        made.close()
    return seen


def _numbers(info: Mapping[str, Any]) -> dict[str, int]:
    sizes = {}
    for key, value in info.items():
        if isinstance(key, str) and isinstance(value, int | float | np.generic | np.ndarray):
            array = np.asarray(value)
            if array.dtype.kind in "biuf" and array.size <= LONGEST:
                sizes[key] = array.size if array.ndim else 0
    return sizes


def screen_shape(env: str, options: Mapping[str, Any]) -> tuple[int, ...]:
    """Return the shape of an environment's pictures, (height, width, 3).

    Raises:
        ValueError: the environment cannot draw; the message says why.
    """
    made = environment.make(env, options, watched=True)
    try:
        with quiet():
            made.reset(seed=0)
            picture: Any = made.render()
            return np.shape(picture)
    except Exception as error:
        raise ValueError(f"{env} cannot draw: {environment.line(error)}") from None
    finally:
        made.close()


def check_food(env: str, options: Mapping[str, Any], function: str) -> None:
    """Try a food function on the result of one step.

    Raises:
        ValueError: there is no such function, or the function returns no number.
    """
    food, made = environment.food_function(function), environment.make(env, options)
    with quiet():
        made.action_space.seed(0)
        made.reset(seed=0)
        given = made.step(made.action_space.sample())
        made.close()
        try:
            amount = food(*given)
        except Exception as error:
            raise ValueError(f"food: {function} fails: {environment.line(error)}") from None
    if not isinstance(amount, int | float | np.number):
        raise ValueError(f"food: {function} gives {amount!r}, which is not a number")
