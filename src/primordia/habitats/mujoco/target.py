"""A target for a robot. When a robot reaches it, the target moves to a random position in a disc."""

import math
from typing import Any

import numpy as np
from pydantic import Field

from primordia.habitats.mujoco.simulator import ids_by_name
from primordia.random import dice
from primordia.settings.base import Settings


class Target(Settings):
    """An object to be reached, which then moves to a random position in a disc of the plane x, y."""

    body: str = Field(description="name of the target's body")
    by: str = Field(description="name of the robot's body that must reach the target")
    within: float = Field(
        gt=0, description="distance between the two bodies at which the target is reached, metres"
    )
    joints: tuple[str, str] = Field(
        strict=False, description="names of the target's slide joints, x and y"
    )
    radius: float = Field(
        gt=0, description="radius of the disc around the origin in which targets appear, metres"
    )

    def check(self, model: Any) -> None:
        """Raise ValueError if a model lacks one of the named bodies or joints."""
        named = {"body": (self.body, self.by), "joint": self.joints}
        for kind, required in named.items():
            known = ids_by_name(model, kind)
            if missing := [name for name in required if name not in known]:
                raise ValueError(
                    f"target: there is no {kind} {missing[0]!r}; known: {', '.join(known)}"
                )

    def joint_addresses(self, model: Any) -> list[tuple[int, int]]:
        """Return the indices in qpos and in qvel of the target's joints, x and y."""
        joints = map(model.joint, self.joints)
        return [(int(joint.qposadr[0]), int(joint.dofadr[0])) for joint in joints]

    def reached(self, positions: dict[str, np.ndarray]) -> np.ndarray:
        """Return which robots reach the target, bool (N,).

        Args:
            positions: name of a body -> the body's positions in metres, (N, 3).
        """
        difference = positions[self.body] - positions[self.by]
        return np.sqrt((difference * difference).sum(axis=1)) < self.within

    def draw_position(self, state: int) -> tuple[int, tuple[float, float]]:
        """Draw a point of the disc from a state of `dice`; return the next state, and x, y in metres."""
        state, of_distance = dice.roll(state)
        state, of_angle = dice.roll(state)
        distance = self.radius * math.sqrt(of_distance / 2**32)
        angle = 2 * math.pi * of_angle / 2**32
        return state, (distance * math.cos(angle), distance * math.sin(angle))
