"""Doors make tasks from only the name of an environment, such as `gym:LunarLander-v3`."""

from textwrap import fill
from typing import Any

import tomli_w

from primordia.settings import parts

DOORS = {"gym": "primordia.habitats.gymnasium.task", "gymnax": "primordia.habitats.gymnax.task"}
"""Module of each door, by the word before the colon. A door has functions `values` and `report`."""
LEAST, MOST = 0.001, 0.5
"""Bounds of the default probability of replication."""
WIDTH = 100
"""Width of comments, in characters."""
DEFAULT = "gym"
"""The door that is used if an environment's name does not begin with a door."""


def is_door(task: str) -> bool:
    """Return whether a task's name begins with a door, such as `gym:`."""
    return task.partition(":")[0] in DOORS and ":" in task


def full(env: str) -> str:
    """Return the name of an environment with its door."""
    return env if is_door(env) else f"{DEFAULT}:{env}"


def values(task: str) -> dict[str, Any]:
    """Return the settings of a task that is made from an environment, as nested tables.

    Raises:
        InputError: there is no such environment, or no organism can live in it; the message says why.
    """
    return _through("values", task)


def replication(lifespan: float) -> float:
    """Return the probability of replication in a tick, from the mean ticks of a life with random actions.

    An organism replicates about once in such a life, since the paper makes the probability "loosely
    proportional to the average lifespan of the initial organisms".
    """
    return round(min(max(1 / max(lifespan, 1), LEAST), MOST), 4)


def text(env: str) -> str:
    """Return a commented TOML file of a task in an environment; see `values`."""
    (facts, faults), table = report(env), values(full(env))
    fatal = table["habitat"]["fatal"]
    lines = [
        f"A task in {env}: `primordia run FILE` runs it. Change any setting.",
        *facts,
        *(f"Found: {fault}." for fault in faults),
        f"The setting fatal is a condition that ends a life, such as: {fatal} or obs[0] < -1.",
        "The setting food is an amount, such as: max(reward, 0); it needs a [metabolism] with store,"
        " drain and gain.",
    ]
    comments = [fill(line, WIDTH, initial_indent="# ", subsequent_indent="#   ") for line in lines]
    return "\n".join([*comments, "", tomli_w.dumps(table)])


def report(env: str) -> tuple[list[str], list[str]]:
    """Return the known facts of an environment and its faults, each in a line."""
    return _through("report", env)


def _through(what: str, env: str) -> Any:
    door, _, name = full(env).partition(":")
    return parts.load("door", f"{DOORS[door]}:{what}", {})(name)
