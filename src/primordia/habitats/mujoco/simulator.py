"""MuJoCo's models: found, compiled, and what in them can be spoken of."""

import hashlib
from functools import cache
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from primordia.habitats.conditions import Names

GYMNASIUM = "gymnasium:"
"""Begins the name of a file that comes with Gymnasium."""
ROOT = 1
"""The first body, after the world itself."""
LACKING = "robots need MuJoCo and Gymnasium's models: pip install 'primordia[mujoco]'"


@cache
def package() -> Any:
    """The mujoco package. Its log is switched off: it would fill the terminal and a file in the current
    folder with what the law knows anyway, that a body's simulation has failed.

    Raises:
        ValueError: it is not installed, or does not like its environment (MUJOCO_GL).
    """
    try:
        mujoco = import_module("mujoco")
        import_module("mujoco.batch")
    except ImportError:
        raise ValueError(LACKING) from None
    except RuntimeError as error:
        raise ValueError(f"MuJoCo cannot be loaded: {error}") from None
    log = mujoco.MjLogConfig.get()
    log.logto_console = log.logto_file = False
    log.set()
    return mujoco


def compiled(file: str, timestep: float | None) -> Any:
    """The MjModel of an MJCF file, its timestep in seconds changed if one is given.

    Raises:
        ValueError: there is no such file, or MuJoCo does not take it, or nothing in it can be moved.
    """
    path = _path(file)
    if not path.is_file():
        raise ValueError(f"file: there is no {path}")
    try:
        model = package().MjModel.from_xml_path(str(path))
    except ValueError as error:
        raise ValueError(f"file: {path}: {' '.join(str(error).split())}") from None
    if not model.nu:
        raise ValueError(f"file: {path} has no actuators, so a brain could do nothing")
    if timestep is not None:
        model.opt.timestep = timestep
    # A simulation that comes to infinity is to stay there, so that its body dies of it.
    model.opt.disableflags |= package().mjtDisableBit.mjDSBL_AUTORESET
    return model


def fingerprint(model: Any) -> str:
    """Twelve digits of the SHA-256 of a model as MuJoCo has compiled it, meshes and all."""
    mujoco = package()
    compiled = np.zeros(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, compiled)
    return f"sha256 {hashlib.sha256(compiled.tobytes()).hexdigest()[:12]}"


def _path(file: str) -> Path:
    if not file.startswith(GYMNASIUM):
        return Path(file)
    package()
    try:
        assets = files("gymnasium") / "envs" / "mujoco" / "assets"
    except ModuleNotFoundError:
        raise ValueError(LACKING) from None
    return Path(str(assets / file.removeprefix(GYMNASIUM)))


def numbered(model: Any, kind: str) -> dict[str, int]:
    """Number of each `body`, `site` or `joint` that has a name."""
    count = {"body": model.nbody, "site": model.nsite, "joint": model.njnt}[kind]
    each = (getattr(model, kind)(i) for i in range(count))
    return {one.name: one.id for one in each if one.name}


def moves_about(model: Any) -> bool:
    """Whether the first joint's position is a place, and not an angle."""
    return bool(model.jnt_type[0] != package().mjtJoint.mjJNT_HINGE)


def names(model: Any) -> Names:
    """What conditions and the rest can speak of, beside targets."""
    return {
        "qpos": model.nq,
        "qvel": model.nv,
        "ctrl": model.nu,
        "xpos": dict.fromkeys(numbered(model, "body"), 3),
        "site": dict.fromkeys(numbered(model, "site"), 3),
        "height": "amount",
        "pitch": "amount",
        "forward": "amount",
        "travelled": "amount",
        "com_forward": "amount",
    }
