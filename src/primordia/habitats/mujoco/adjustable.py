"""Physical parameters of a user's own: any numbers of a model's elements, such as lengths and gears.

A body whose parameters differ has a model of its own, which MuJoCo compiles from its editable form
(`MjSpec`). So MuJoCo derives masses, inertias and bounds from new lengths, and refuses what is no body.

A robot that can move up and down is born as far above the ground as the usual one, however long its legs.
"""

import re
from collections.abc import Mapping
from functools import partial
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from primordia.habitats.mujoco import physics
from primordia.habitats.mujoco.simulator import ROOT, compiled, editable, finished, package
from primordia.settings.tables import did_you_mean

KINDS = {
    "body": "bodies",
    "geom": "geoms",
    "joint": "joints",
    "site": "sites",
    "actuator": "actuators",
    "tendon": "tendons",
}
"""Kinds of elements, and the name of the list of all elements of a kind in MjSpec."""
Pairs: TypeAlias = list[list[int]]
"""Numbers of two geoms each."""
FAR = 1000.0
"""Largest distance in m that is measured; a robot that is farther from the ground stays where it is."""
TARGET = re.compile(rf"({'|'.join(KINDS)})\.(.+)\.([a-z_]+)(?:\[(\d)\])?")


class Target(NamedTuple):
    """One attribute of an element of a model."""

    kind: str
    element: str
    attribute: str
    place: int | None
    """the number in the attribute that is multiplied; None: all numbers"""
    value: np.ndarray
    """the attribute in the file, (n,)"""


class Adjustable:
    """The models of bodies whose parameters differ."""

    def __init__(
        self,
        file: str,
        timestep: float | None,
        table: Mapping[str, tuple[str, ...]],
        forces: bool = False,
        textures: bool = False,
    ) -> None:
        """Read a model.

        Args:
            file: an MJCF file.
            timestep: see `load_model`.
            table: name of a parameter -> the attributes that it multiplies, such as `geom.thigh.size[1]`.
            forces: see `load_model`.
            textures: keep textures, which take most of the time and memory of a model.

        Raises:
            ValueError: an attribute is not in the model; the message says which.
        """
        self._spec = editable(file, forces, textures)
        self._finish = partial(finished, timestep=timestep)
        usual = compiled(self._spec)
        self._pairs = _touching(usual) if _can_rise(usual) else []
        self._clearance = _clearance(usual, package().MjData(usual), self._pairs)
        self._targets = [[_target(self._spec, n, each) for each in own] for n, own in table.items()]

    def model(self, factors: tuple[float, ...]) -> Any:
        """Return the MjModel of a body.

        Args:
            factors: of the parameters that `physics` offers, and then of those in the table.

        Raises:
            ValueError: MuJoCo does not accept such a body.
        """
        own = len(factors) - len(self._targets)
        for targets, factor in zip(self._targets, factors[own:], strict=True):
            for kind, element, attribute, place, value in targets:
                scaled = value.copy()
                scaled[slice(None) if place is None else place] *= factor
                setattr(_element(self._spec, kind, element), attribute, _as_set(scaled))
        model = self._finish(compiled(self._spec))
        state = package().MjData(model)  # which takes a third of the time of a model
        _lift(model, self._clearance - _clearance(model, state, self._pairs))
        physics.scale_model(model, state, factors[:own])
        return model


def _clearance(model: Any, state: Any, pairs: Pairs) -> float:
    """Return the least distance in m between geoms in the pose at birth; in the ground it is negative."""
    package().mj_kinematics(model, state)
    distance = package().mj_geomDistance
    return min((distance(model, state, *pair, FAR, None) for pair in pairs), default=0.0)


def _touching(model: Any) -> Pairs:
    """Return the pairs of a geom of the world and one of the robot that can collide."""
    kind, accepts, static = model.geom_contype, model.geom_conaffinity, model.geom_bodyid == 0
    touch = (kind[:, None] & accepts) | (kind & accepts[:, None])
    return np.argwhere((touch != 0) & static[:, None] & ~static).tolist()


def _can_rise(model: Any) -> bool:
    """Return whether a joint of the robot's first body lets it rise."""
    kinds, joint = model.jnt_type, package().mjtJoint
    slides_up = (kinds == joint.mjJNT_SLIDE) & (model.jnt_axis[:, 2] != 0)
    rises = slides_up | (kinds == joint.mjJNT_FREE)
    return bool(np.any(rises & (model.jnt_bodyid == ROOT)))


def _lift(model: Any, metres: float) -> None:
    """Raise the place in which the robot is born."""
    model.body_pos[ROOT, 2] += metres
    if model.jnt_type[0] == package().mjtJoint.mjJNT_FREE:
        model.qpos0[2] += metres


def _as_set(value: np.ndarray) -> Any:
    return float(value[0]) if len(value) == 1 else value


def _element(spec: Any, kind: str, name: str) -> Any:
    return getattr(spec, kind)(name)


def _target(spec: Any, parameter: str, text: str) -> Target:
    where, match = f"adjustable.{parameter}", TARGET.fullmatch(text)
    if match is None:
        raise ValueError(
            f"{where}: {text!r} does not name an attribute; write KIND.NAME.ATTRIBUTE, such as"
            f" geom.thigh.size[1], and as KIND one of {', '.join(KINDS)}"
        )
    kind, name, attribute, digit = match.groups()
    element, place = _element(spec, kind, name), None if digit is None else int(digit)
    if element is None:
        names = [each.name for each in getattr(spec, KINDS[kind]) if each.name]
        near = did_you_mean(name, names)
        raise ValueError(f"{where}: the model has no {kind} called {name!r}{near}")
    try:
        value = np.atleast_1d(np.array(getattr(element, attribute), float))
    except (AttributeError, TypeError, ValueError):
        raise ValueError(f"{where}: a {kind} has no numbers called {attribute!r}") from None
    if place is not None and place >= len(value):
        raise ValueError(f"{where}: {attribute} of a {kind} has {len(value)} numbers, from 0")
    chosen = value if place is None else value[place]
    if not np.isfinite(chosen).all() or not np.any(chosen):
        raise ValueError(
            f"{where}: {text} is not a number other than 0 in the file, so a factor would change"
            " nothing; state it there, or name another attribute"
        )
    return Target(kind, name, attribute, place, value)
