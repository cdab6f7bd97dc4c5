"""Environments of Gymnasium: made by name, without time limit."""

import os
from collections.abc import Callable, Mapping
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import gymnasium
from gymnasium import Env
from gymnasium.envs.registration import EnvSpec

from primordia import own_code
from primordia.habitats import opengl
from primordia.habitats.silence import quiet, silent

PICTURES = "rgb_array"
"""The render mode of an environment that is watched."""


def make(env: str, options: Mapping[str, Any], watched: bool = False) -> Env:
    """Return an environment without its time limit.

    Args:
        env: the environment's registered name, or `module:NAME` with the module that registers it.
        options: keyword arguments.
        watched: whether the environment must be able to draw pictures.

    Raises:
        ValueError: the environment cannot be made; a message of one line says why.
    """
    module, colon, _ = env.partition(":")
    drawing = {"render_mode": PICTURES} if watched else {}
    if watched:
        os.environ.setdefault(opengl.VARIABLE, opengl.backend())
    try:
        with quiet(), silent():
            if colon:
                own_code.load(module)
            made = gymnasium.make(
                env, max_episode_steps=-1, disable_env_checker=True, **options, **drawing
            )
    except (Exception, SystemExit) as error:  # an error of a module or environment of the user's
        raise ValueError(f"env: {env} cannot be made: {line(error)}") from None
    if made.spec is not None and made.spec.id != (name := env.rpartition(":")[2]):
        made.close()
        whole = env.removesuffix(name) + made.spec.id  # the name of a version, which may change
        raise ValueError(f"env: there is no {env}; did you mean {whole}?")
    return made


def spec(env: str) -> EnvSpec:
    """Return the registration of an environment that has been made."""
    return gymnasium.spec(env.rpartition(":")[2])


def line(error: BaseException) -> str:
    """Return an error in one line."""
    text = " ".join(str(error).split())
    known = isinstance(error, gymnasium.error.Error) and text
    return text if known else f"{type(error).__name__}: {text}".removesuffix(": ")


def food_function(name: str) -> Callable[..., float]:
    """Return the function `module:function` of (observation, reward, terminated, truncated, info).

    Raises:
        ValueError: there is no such function.
    """
    module, _, attribute = name.partition(":")
    try:
        found = getattr(own_code.load(module), attribute)
    except (Exception, SystemExit) as error:  # the module is the user's
        raise ValueError(f"food: {name} cannot be loaded: {line(error)}") from None
    if not callable(found):
        raise ValueError(f"food: {name} is not a function")
    return found


def versions(env: str) -> dict[str, str]:
    """Return the known versions of the packages that an environment comes from."""
    entry = spec(env).entry_point
    path = str(entry).split(":")[0] if isinstance(entry, str) else getattr(entry, "__module__", "")
    engines = {"gymnasium.envs.box2d": ["box2d"], "gymnasium.envs.mujoco": ["mujoco"]}
    own = next((each for start, each in engines.items() if path.startswith(start)), [])
    top = path.partition(".")[0]
    # Gymnasium's own package is known, and to list all packages takes up to a second.
    others = own_code.packages([top]) if top not in ("", "gymnasium") else []
    names = {"gymnasium", "numpy", *own, *others}
    found = {}
    for name in sorted(names):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found
