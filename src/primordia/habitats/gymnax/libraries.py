"""Environments by name, from libraries in JAX or from your own modules."""

from collections.abc import Callable
from functools import cache, partial
from importlib import import_module
from importlib.metadata import version
from pkgutil import iter_modules
from typing import Any

from primordia import own_code
from primordia.habitats.gymnax.playground import Playground, is_playground
from primordia.habitats.silence import quiet
from primordia.settings.tables import did_you_mean

CRAFTAX = (
    "Craftax-Classic-Symbolic-v1",
    "Craftax-Symbolic-v1",
    "Craftax-Classic-Pixels-v1",
    "Craftax-Pixels-v1",
)
LIBRARIES = {
    "gymnax": ("gymnax", "flax"),
    "craftax": ("craftax", "flax"),
    "octax": ("octax", "flax"),
    "playground": ("playground", "mujoco-mjx", "mujoco", "flax"),
}
"""The packages that compute the environments of a library."""
NEVER = 2**31 - 1
"""A time limit that is never reached."""


def package_of(name: str) -> str:
    """Return the package in which an environment is looked up."""
    package, colon, _ = name.partition(":")
    if colon:
        return package
    return "craftax" if name.startswith("Craftax") else "gymnax"


def make(name: str, time_limit: bool) -> Any:
    """Return an environment with the interface of gymnax.

    Args:
        name: an environment of gymnax or Craftax, `package:NAME` for another library, or your own
            `module:Class` or `module:function`.
        time_limit: whether to keep a time limit that can be set only when the environment is made.

    Raises:
        ValueError: there is no such environment, or its library is not installed.
    """
    package, wanted = package_of(name), name.rpartition(":")[2]
    makers: dict[str, Callable[[str], Any]] = {
        "gymnax": _of_gymnax,
        "craftax": _of_craftax,
        "octax": partial(_of_octax, time_limit=time_limit),
        "playground": _of_playground,
    }
    if package not in makers:
        return _own(name)
    try:
        with quiet():  # Craftax prints the source of its textures
            return makers[package](wanted)
    except ImportError as error:
        raise ValueError(
            f"env: {name} needs {package}: pip install 'primordia[{package}]' ({error})"
        ) from None


def _of_gymnax(name: str) -> Any:
    gymnax = import_module("gymnax")
    _check_known(name, gymnax.registered_envs, "gymnax")
    try:
        return gymnax.make(name)[0]
    except OSError as error:
        raise ValueError(f"env: {name} cannot be made: {error}") from None


def _of_craftax(name: str) -> Any:
    _check_known(name, CRAFTAX, "craftax")
    return import_module("craftax.craftax_env").make_craftax_env_from_name(name, auto_reset=False)


def _of_octax(name: str, time_limit: bool) -> Any:
    games = import_module("octax.environments")
    stem = name.replace("-", "_").rstrip("0123456789")
    known = [each.name for each in iter_modules(games.__path__)]
    _check_known(stem, known, "octax")
    limits = {} if time_limit else {"max_num_steps_per_episodes": NEVER}
    env = games.create_environment(name, **limits)[0]
    return import_module("octax.wrappers").OctaxGymnaxWrapper(env)


def _of_playground(name: str) -> Any:
    """Return a task of MuJoCo Playground, computed by MJX in JAX, since Warp needs an NVIDIA GPU."""
    registry = import_module("mujoco_playground").registry
    _check_known(name, registry.ALL_ENVS, "playground")
    robots = import_module("mujoco_playground._src.mjx_env").MENAGERIE_PATH
    if name not in registry.dm_control_suite.ALL_ENVS and not robots.exists():
        raise ValueError(
            f"env: {name} needs the models of robots that MuJoCo Playground downloads; load them once"
            f" with `mujoco_playground.registry.load({name!r})`"
        )
    return Playground(registry.load(name, config_overrides={"impl": "jax"}))


def _check_known(name: str, known: Any, package: str) -> None:
    if name not in known:
        near = did_you_mean(name, list(known)) or f"; known: {', '.join(known)}"
        raise ValueError(f"env: {package} has no environment {name!r}{near}")


def _own(name: str) -> Any:
    """Return an environment of the user's own, of `module:Class` or `module:function`."""
    module, _, attribute = name.partition(":")
    try:
        env = getattr(own_code.load(module), attribute)()
    except (Exception, SystemExit) as error:  # the user's module may raise any error
        raise ValueError(f"env: {name!r} cannot be made: {error}") from error
    if is_playground(env):
        return Playground(env)
    lacking = [
        each
        for each in ("default_params", "reset_env", "step_env", "action_space")
        if not hasattr(env, each)
    ]
    if lacking:
        raise ValueError(
            f"env: {name} has no {', '.join(lacking)}, which every environment of gymnax has"
        )
    return env


@cache
def versions(name: str) -> dict[str, str]:
    """Return the versions of the packages that compute an environment of a library."""
    return {each: version(each) for each in LIBRARIES.get(package_of(name), ())}
