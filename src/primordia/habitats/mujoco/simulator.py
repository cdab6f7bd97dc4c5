"""MuJoCo's models: how they are loaded, and their observables."""

import hashlib
import warnings
from functools import cache
from importlib import import_module
from importlib.resources import files
from os.path import abspath, isfile, relpath  # false, not an error, for a name that is too long
from pathlib import Path
from typing import Any

from primordia.habitats.conditions import Names

GYMNASIUM = "gymnasium:"
"""Prefix of the names of files that come with Gymnasium."""
ROOT = 1
"""The robot's first body; body 0 is the world."""
FORCES = "primordia: forces"
"""The name of the sensor and the site that `load_model` may add"""
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
    except Exception as error:  # without the library that MUJOCO_GL names, errors are of many kinds
        raise ValueError(f"MuJoCo cannot be loaded with this MUJOCO_GL: {error}") from None
    log = mujoco.MjLogConfig.get()
    log.logto_console = log.logto_file = False
    log.set()
    return mujoco


def load_model(file: str, timestep: float | None, forces: bool = False) -> Any:
    """Return the MjModel of an MJCF file.

    Args:
        file: an MJCF file, or gymnasium:NAME.xml.
        timestep: another timestep in seconds, or None.
        forces: let MuJoCo compute `cfrc_ext`, which it does only for models with a sensor of forces. The
            sensor FORCES is added as the last, on a site of the robot's first body.

    Raises:
        ValueError: there is no such file, MuJoCo does not accept it, or it has no actuators.
    """
    path = _path(file)
    if not isfile(path):
        raise ValueError(f"file: there is no {path}")
    try:
        read = package().MjModel.from_xml_path
        model = compiled(editable(file, forces)) if forces else read(str(path))
    except ValueError as error:
        raise ValueError(f"file: {path}: {' '.join(str(error).split())}") from None
    if not model.nu:
        raise ValueError(f"file: {path} has no actuators, so a brain could do nothing")
    return finished(model, timestep)


def finished(model: Any, timestep: float | None) -> Any:
    """Return a compiled model with its options set; see `load_model`."""
    if timestep is not None:
        model.opt.timestep = timestep
    # A state that is not finite must not be reset, so that its body dies of a fault.
    model.opt.disableflags |= package().mjtDisableBit.mjDSBL_AUTORESET
    return model


def _spec(file: str | Path) -> Any:
    """Return the MjSpec of an MJCF file, without warnings of what MuJoCo will no longer accept."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return package().MjSpec.from_file(str(file))


def compiled(spec: Any) -> Any:
    """Return the MjModel of an MjSpec, without such warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()


def editable(file: str, forces: bool, textures: bool = True) -> Any:
    """Return the MjSpec of an MJCF file; see `load_model`.

    Without `textures` the model is the same to the simulator, and a twentieth of the size.
    """
    spec, mujoco = _spec(_path(file)), package()
    if forces:
        spec.bodies[ROOT].add_site(name=FORCES)
        kind, on = mujoco.mjtSensor.mjSENS_FORCE, mujoco.mjtObj.mjOBJ_SITE
        spec.add_sensor(name=FORCES, type=kind, objtype=on, objname=FORCES)
    if not textures:
        for material in spec.materials:
            material.textures = [""] * len(material.textures)
        for texture in list(spec.textures):
            spec.delete(texture)
    return spec


def needed_files(file: str) -> list[str]:
    """Return the full paths of an MJCF file, and of its includes, meshes, textures and height fields."""
    known, spec = package().mju_getXMLDependencies(file), _spec(file)
    # MuJoCo 3.17 looks for height fields in `meshdir`, but its list of dependencies leaves this out.
    fields = [Path(file).parent / spec.meshdir / each.file for each in spec.hfields if each.file]
    return sorted({abspath(each) for each in (*known, *fields) if isfile(each)})


def fingerprint(file: str) -> str:
    """Return twelve digits of a SHA-256 of an MJCF file and all files that it needs, wherever they are.

    A compiled model holds full paths, so the same model differs from place to place.
    """
    path, digest = _path(file), hashlib.sha256()
    for each in needed_files(str(path)):
        content = hashlib.sha256(Path(each).read_bytes()).hexdigest()
        digest.update(f"{relpath(each, path.parent)} {content}\n".encode())
    return f"sha256 {digest.hexdigest()[:12]}"


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


def sensors(model: Any) -> dict[str, slice]:
    """Return the columns of `sensordata` of each sensor that has a name."""
    each = [model.sensor(i) for i in range(model.nsensor)]
    begin = {one.name: int(one.adr[0]) for one in each if one.name}
    return {name: slice(i, i + int(model.sensor(name).dim[0])) for name, i in begin.items()}


def observables(model: Any) -> Names:
    """Return the names that expressions in settings can use, except those of a target."""
    sensed = {name: each.stop - each.start for name, each in sensors(model).items()}
    of_some_models = {"act": model.na, "sensordata": model.nsensordata, "sensor": sensed}
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
        "time": "amount",
        "mass": "amount",
        "cfrc_ext": dict.fromkeys(ids_by_name(model, "body"), 6),
        **{name: kind for name, kind in of_some_models.items() if kind},
    }
