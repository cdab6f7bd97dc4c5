"""Something that a robot is to reach, and that is elsewhere in a disc as soon as it has."""

import math
from typing import Any

import numpy as np
from pydantic import Field

from primordia.habitats.mujoco.simulator import numbered
from primordia.random import dice
from primordia.settings.base import Settings


class Target(Settings):
    """Something to be reached; it then is elsewhere in a disc of the plane x, y."""

    body: str = Field(description="the body that is to be reached")
    by: str = Field(description="the body that reaches it")
    within: float = Field(gt=0, description="metres between the two")
    joints: tuple[str, str] = Field(strict=False, description="slide joints of the first, x and y")
    radius: float = Field(gt=0, description="metres; of the disc, around the origin")

    def check(self, model: Any) -> None:
        """Whether a model has what is spoken of.

        Raises:
            ValueError: it lacks a body or a joint.
        """
        named = {"body": (self.body, self.by), "joint": self.joints}
        for kind, wanted in named.items():
            known = numbered(model, kind)
            if missing := [name for name in wanted if name not in known]:
                raise ValueError(
                    f"target: there is no {kind} {missing[0]!r}; known: {', '.join(known)}"
                )

    def slides(self, model: Any) -> list[tuple[int, int]]:
        """Where its joints, x and y, stand among a model's positions and among its velocities."""
        joints = map(model.joint, self.joints)
        return [(int(joint.qposadr[0]), int(joint.dofadr[0])) for joint in joints]

    def reached(self, places: dict[str, np.ndarray]) -> np.ndarray:
        """By whom, bool (N,), of the places of bodies by name, float64 (N, 3) in metres."""
        apart = places[self.body] - places[self.by]
        return np.sqrt((apart * apart).sum(axis=1)) < self.within

    def somewhere(self, state: int) -> tuple[int, tuple[float, float]]:
        """Anywhere in its disc with equal chance: a state of `dice` -> the next one, x and y (m)."""
        state, one = dice.roll(state)
        state, other = dice.roll(state)
        distance, angle = self.radius * math.sqrt(one / 2**32), 2 * math.pi * other / 2**32
        return state, (distance * math.cos(angle), distance * math.sin(angle))
