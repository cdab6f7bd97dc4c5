"""MuJoCo's models: how they are loaded, and their observables."""

import hashlib
from functools import cache
from importlib import import_module
from importlib.resources import files
from os.path import isfile  # false, not an error, for a name that is too long
from pathlib import Path
from typing import Any

import numpy as np

from primordia.habitats.conditions import Names

GYMNASIUM = "gymnasium:"
"""Prefix of the names of files that come with Gymnasium."""
ROOT = 1
"""The robot's first body; body 0 is the world."""
NOT_INSTALLED = "robots need MuJoCo and Gymnasium's models: pip install 'primordia[mujoco]'"


@cache
def package() -> Any:
    """Return the mujoco package, with its log switched off.

    The log would report every failed simulation, on the terminal and in a file of the current folder. The
    law reports these as faults.

    Raises:
        ValueError: MuJoCo is not installed, or cannot be loaded with this MUJOCO_GL.
    """
    try:
        mujoco = import_module("mujoco")
        import_module("mujoco.batch")
    except ImportError:
        raise ValueError(NOT_INSTALLED) from None
    except RuntimeError as error:
        raise ValueError(f"MuJoCo cannot be loaded: {error}") from None
    log = mujoco.MjLogConfig.get()
    log.logto_console = log.logto_file = False
    log.set()
    return mujoco


def load_model(file: str, timestep: float | None) -> Any:
    """Return the MjModel of an MJCF file, with another timestep in seconds if one is given.

    Raises:
        ValueError: there is no such file, MuJoCo does not accept it, or it has no actuators.
    """
    path = _path(file)
    if not isfile(path):
        raise ValueError(f"file: there is no {path}")
    try:
        model = package().MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise ValueError(f"file: {path}: {' '.join(str(error).split())}") from None
    if not model.nu:
        raise ValueError(f"file: {path} has no actuators, so a brain could do nothing")
    if timestep is not None:
        model.opt.timestep = timestep
    # A state that is not finite must not be reset, so that its body dies of a fault.
    model.opt.disableflags |= package().mjtDisableBit.mjDSBL_AUTORESET
    return model


def fingerprint(model: Any) -> str:
    """Return twelve digits of the SHA-256 of a compiled model, with its meshes."""
    mujoco = package()
    binary = np.zeros(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, binary)
    return f"sha256 {hashlib.sha256(binary.tobytes()).hexdigest()[:12]}"


def _path(file: str) -> Path:
    if not file.startswith(GYMNASIUM):
        return Path(file)
    package()
    try:
        assets = files("gymnasium") / "envs" / "mujoco" / "assets"
    except ModuleNotFoundError:
        raise ValueError(NOT_INSTALLED) from None
    return Path(str(assets / file.removeprefix(GYMNASIUM)))


def ids_by_name(model: Any, kind: str) -> dict[str, int]:
    """Return the id of each `body`, `site` or `joint` that has a name."""
    count = {"body": model.nbody, "site": model.nsite, "joint": model.njnt}[kind]
    elements = (getattr(model, kind)(i) for i in range(count))
    return {element.name: element.id for element in elements if element.name}


def root_translates(model: Any) -> bool:
    """Return whether the first joint's position is a place rather than an angle."""
    return bool(model.jnt_type[0] != package().mjtJoint.mjJNT_HINGE)


def observables(model: Any) -> Names:
    """Return the names that expressions in settings can use, except those of a target."""
    return {
        "qpos": model.nq,
        "qvel": model.nv,
        "ctrl": model.nu,
        "xpos": dict.fromkeys(ids_by_name(model, "body"), 3),
        "site": dict.fromkeys(ids_by_name(model, "site"), 3),
        "height": "amount",
        "pitch": "amount",
        "forward": "amount",
        "travelled": "amount",
        "com_forward": "amount",
    }
