"""A task made from an environment alone, for `primordia run gymnax:NAME`, `new` and `check`."""

from functools import cache
from typing import Any

from primordia.habitats.contract import Discrete, find
from primordia.habitats.gymnax.check import BODIES, TICKS, Measured, measure
from primordia.habitats.gymnax.habitat import Gymnax
from primordia.printable import counted
from primordia.settings.doors import Task, settings
from primordia.settings.making import make

PLAIN = 5.0
"""Unbounded observations that stay below this in random play are not scaled."""


@cache
def task(env: str) -> Task:
    """Return the task that is made from an environment, after measuring the environment.

    Raises:
        InputError: there is no such environment, or it cannot be used; the message says why.
    """
    # With this setting a task's bodies of MJX are those measured, and are compiled once.
    habitat = make("habitat", {"name": "gymnax", "env": env, "squash": True}, find)
    assert isinstance(habitat, Gymnax)
    return _task(env, habitat, measure(habitat))


def _task(env: str, habitat: Gymnax, found: Measured) -> Task:
    large = bool((habitat.senses.unbounded() & (found.largest > PLAIN)).any())
    own = {"name": "gymnax", "env": env, "fatal": "done"} | ({"squash": True} if large else {})
    table = settings(f"{env}: live until it is done", found.lifespan, own)
    return Task(table, _facts(habitat, found), found.faults)


def _facts(habitat: Gymnax, found: Measured) -> list[str]:
    """Return the facts of an environment for the author of a task, each in a line."""
    action = habitat.action
    named: dict[str, Any] = dict(habitat.names)
    choice = isinstance(action, Discrete)
    what = f"one of {action.size}" if choice else counted(action.size, "number")
    limits = ", ".join(habitat.simulator.limits)
    grid = habitat.senses.grid
    return [
        f"Observation: {named['obs']} numbers, obs[0] to obs[{named['obs'] - 1}] in conditions.",
        *([_around(grid)] if grid and 1 < grid[2] <= min(grid[:2]) else []),
        f"Action: {what}.",
        *(f"Numbers in {part}: {_listed(part, named[part])}." for part in ("state", "info")),
        f"The environment's time limit ({limits}) is off; time_limit = true turns the limit on."
        if limits
        else "The environment has no time limit.",
        "After an interruption, lives go on exactly from their saved states.",
        f"With random actions, a life has {found.lifespan:,.0f} ticks on average."
        if found.ended
        else f"None of {BODIES} lives ended in {TICKS} ticks of random play: set `fatal` to a condition,"
        " or add a metabolism.",
    ]


def _around(grid: tuple[int, ...]) -> str:
    height, width, channels = grid
    return (
        f"The observation is a grid of {height} x {width} cells with {channels} channels. If one channel"
        " shows the player and nothing else, centre (its number, from 0) and sight = 2 limit the senses"
        " to the 5 x 5 cells around the player."
    )


def _listed(part: str, kinds: dict[str, Any]) -> str:
    """List names without private parts; states of MJX have dozens of these."""
    public = (name for name in kinds if not name.startswith("_") and "._" not in name)
    return ", ".join(f'{part}["{name}"]' for name in public) or "none"
