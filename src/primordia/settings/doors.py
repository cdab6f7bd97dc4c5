"""Doors make tasks from only the name of an environment, such as `gym:LunarLander-v3`."""

from textwrap import fill
from typing import Any, NamedTuple

import tomli_w

from primordia.settings import parts

DOORS = {"gym": "primordia.habitats.gymnasium.task", "gymnax": "primordia.habitats.gymnax.task"}
"""Module of each door, by the word before the colon. A door has a function `task`."""
LEAST, MOST = 0.001, 0.5
"""Bounds of the default probability of replication."""
WIDTH = 100
"""Width of comments, in characters."""
DEFAULT = "gym"
"""The door that is used if an environment's name does not begin with a door."""


class Task(NamedTuple):
    """A task that is made from an environment."""

    table: dict[str, Any]
    """settings, as nested tables"""
    facts: list[str]
    """what is known of the environment, each fact in a line"""
    faults: list[str]
    """what is wrong with the environment, each fault in a line"""


def is_door(task: str) -> bool:
    """Return whether a task's name begins with a door, such as `gym:`."""
    return task.partition(":")[0] in DOORS and ":" in task


def full(env: str) -> str:
    """Return the name of an environment with its door."""
    return env if is_door(env) else f"{DEFAULT}:{env}"


def task(env: str) -> Task:
    """Return the task that is made from an environment.

    Raises:
        InputError: there is no such environment, or no organism can live in it; the message says why.
    """
    door, _, name = full(env).partition(":")
    return parts.load("door", f"{DOORS[door]}:task", {})(name)


def settings(about: str, lifespan: float, habitat: dict[str, Any]) -> dict[str, Any]:
    """Return the settings of a task.

    Args:
        about: what ends a life.
        lifespan: mean ticks of a life with random actions. An organism replicates about once in
            such a life, since the paper makes the probability "loosely proportional to the average
            lifespan of the initial organisms".
        habitat: the settings of the habitat, with its `env`.
    """
    return {
        "task": habitat["env"].rpartition(":")[2].replace("/", "-"),
        "about": about,
        "genesis": "fill",
        "replication": round(min(max(1 / max(lifespan, 1), LEAST), MOST), 4),
        "habitat": habitat,
        "mutation": {"probability": 0.5, "scale": 0.02, "founder_scale": 0.3},
    }


def text(env: str) -> str:
    """Return a commented TOML file of a task in an environment; see `task`."""
    table, facts, faults = task(env)
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
