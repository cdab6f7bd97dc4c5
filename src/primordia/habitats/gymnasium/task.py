"""A task made from an environment alone, for `primordia run gym:NAME` and `primordia new`."""

from functools import cache
from typing import Any

import numpy as np

from primordia.errors import InputError
from primordia.settings.doors import Task, settings

PLAIN = 5.0
"""Unbounded observations that stay below this in random play are not scaled."""
SAVING = {
    "snapshot": "After an interruption, lives go on exactly from their saved states",
    "replay": "After an interruption, lives are repeated exactly, from their seed and actions",
    "restart": "After an interruption, lives cannot go on exactly",
}


@cache
def task(env: str) -> Task:
    """Return the task that is made from an environment, after measuring the environment.

    Raises:
        InputError: Gymnasium is not installed, or the environment cannot be used; the message says why.
    """
    try:
        from primordia.habitats.gymnasium.check import measure
        from primordia.habitats.gymnasium.probe import info_of, probe
    except ImportError:
        from primordia.habitats.gymnasium.habitat import NOT_INSTALLED

        raise InputError(NOT_INSTALLED) from None
    try:
        about, found = probe(env, {}), measure(env, {})
        scale = _scale(env) if about.observation.unbounded().any() else []
        keys = info_of(env, {})
    except ValueError as error:
        raise InputError(str(error)) from None
    own = {
        "name": "gymnasium",
        "env": env,
        "fatal": "terminated",
        "saving": found.saving,
        **({"fresh": True} if found.fresh else {}),
        **({"scale": scale} if scale else {}),
    }
    table = settings(f"Gymnasium's {env}: live until it terminates", found.lifespan, own)
    return Task(table, _facts(env, about, found, keys), found.faults)


def _scale(env: str) -> list[float]:
    """Return a divisor for each number of an observation: in random play all are then about -1 to 1.

    The divisor is 1 if there are bounds, or if observations stay small. The result is empty if all
    are 1.
    """
    from primordia.habitats.gymnasium.probe import probe, random_play

    observation = probe(env, {}).observation
    largest = np.abs([row for row, _ in random_play(env, {})]).max(axis=0)
    large = observation.unbounded() & (largest > PLAIN)
    scale = [float(f"{each:.1g}") if own else 1.0 for each, own in zip(largest, large, strict=True)]
    return scale if large.any() else []


def _facts(env: str, about: Any, found: Any, keys: dict[str, int]) -> list[str]:
    """Return the facts of an environment for the author of a task, each in a line."""
    from primordia.habitats.gymnasium.environment import make
    from primordia.habitats.gymnasium.spaces import described

    made = make(env, {})
    one_line = [described(each) for each in (made.observation_space, made.action_space)]
    named = ", ".join(f'info["{key}"]' for key in keys) or "none"
    return [
        f"Observation: {one_line[0]}; obs[0] to obs[{about.observation.width - 1}] in conditions.",
        f"Action: {one_line[1]}.",
        f"Numbers in info: {named}.",
        f"The environment's limit of {about.limit} steps is off; time_limit = {about.limit} turns"
        " the limit on."
        if about.limit
        else "The environment has no time limit.",
        SAVING[found.saving] + (f" ({found.why})." if found.why else "."),
        f"With random actions, a life has {found.lifespan:,.0f} ticks on average."
        if found.ended
        else "No life ended in random play: set `fatal` to a condition, or add a metabolism.",
    ]
