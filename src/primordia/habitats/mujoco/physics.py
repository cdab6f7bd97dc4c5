"""Physical parameters of a MuJoCo model that may differ from body to body."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from primordia.habitats.mujoco.simulator import package

FIELDS = {
    "gravity": ("opt.gravity",),
    "mass": ("body_mass", "body_inertia"),
    "friction": ("geom_friction", "pair_friction"),
    "damping": ("dof_damping",),
    "density": ("opt.density",),
    "viscosity": ("opt.viscosity",),
}
"""The fields of the model that a parameter multiplies; density and viscosity are those of the medium."""
DERIVING = "mass"
"""The parameter from which MuJoCo derives other constants of a model."""


def offered(model: Any) -> tuple[str, ...]:
    """Return the parameters that are not zero everywhere in a model; a factor would change nothing."""
    return tuple(
        name
        for name, fields in FIELDS.items()
        if any(np.any(_value(model, field)) for field in fields)
    )


def scale(model: Any, batch: Any, cells: np.ndarray, factors: np.ndarray) -> None:
    """Multiply the parameters of some bodies.

    Args:
        model: the MjModel, which has the parameters at birth.
        batch: the `mujoco.batch.Batch` of bodies.
        cells: the cells of the bodies, (K,).
        factors: float32 (K, P), of the parameters `offered`.
    """
    names = offered(model)
    for name, factor in zip(names, factors.T.astype(np.float64), strict=True):
        for field in FIELDS[name]:
            value = np.asarray(_value(model, field))
            batch.expand(field)[cells] = value * factor.reshape(-1, *[1] * value.ndim)
    if DERIVING in names:
        batch.set_const(cells)


def scale_model(model: Any, state: Any, factors: Sequence[float]) -> None:
    """Multiply the parameters of one model by factors, (P,), of the parameters `offered`.

    `state` is an MjData of the model, which is overwritten.
    """
    for name, factor in zip(offered(model), factors, strict=True):
        for field in FIELDS[name]:
            value = _value(model, field)
            if np.ndim(value):
                value[:] *= factor
            else:
                setattr(model.opt, field.removeprefix("opt."), value * factor)
    package().mj_setConst(model, state)


def _value(model: Any, field: str) -> Any:
    group, _, name = field.rpartition(".")
    return getattr(model.opt if group else model, name)
