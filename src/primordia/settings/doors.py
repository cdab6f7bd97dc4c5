"""Doors: tasks that are made from the name of an environment alone, such as `gym:LunarLander-v3`."""

from typing import Any

from primordia.settings import parts

DOORS = {"gym": "primordia.habitats.gymnasium.task"}
"""Module of each door, by the word before the colon. It has functions `values`, `text` and `report`."""
DEFAULT = "gym"
"""The door of a name without one, where a name can be nothing else than an environment's."""


def is_door(task: str) -> bool:
    """Return whether a task is the name of an environment behind a door."""
    return task.partition(":")[0] in DOORS and ":" in task


def values(task: str) -> dict[str, Any]:
    """Return the settings of a task that is made from an environment, as nested tables.

    Raises:
        InputError: there is no such environment, or organisms cannot live in it; the message says why.
    """
    return _through("values", task)


def text(env: str) -> str:
    """Return a commented TOML file of a task in an environment; see `values`."""
    return _through("text", env)


def report(env: str) -> tuple[list[str], list[str]]:
    """Return what is known of an environment, and what was found to be wrong with it, a line each."""
    return _through("report", env)


def _through(what: str, env: str) -> Any:
    door, _, name = env.partition(":") if is_door(env) else (DEFAULT, "", env)
    return parts.load("door", f"{DOORS[door]}:{what}", {})(name)
