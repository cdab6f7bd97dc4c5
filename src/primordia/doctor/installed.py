"""What is installed on this machine, what could be added, and what there is to compute with."""

import platform
import shutil
import tempfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import jax

from primordia import cores, device
from primordia.engine.memory import bytes_available

EXTRAS = {
    "atari": ("ale-py", "Atari games"),
    "craftax": ("craftax", "the environments of Craftax"),
    "gpu": ("jax-cuda12-plugin", "NVIDIA GPUs"),
    "gymnasium": ("gymnasium", "environments of Gymnasium"),
    "gymnax": ("gymnax", "the environments of gymnax"),
    "mujoco": ("mujoco", "robots, and your own MJCF models"),
    "octax": ("octax", "games of CHIP-8"),
    "onnx": ("jax2onnx", "policies as ONNX files"),
    "playground": ("playground", "tasks of MuJoCo Playground"),
    "ray": ("ray", "experiments on a Ray cluster"),
    "tensorboard": ("tensorboardX", "metrics in TensorBoard"),
    "wandb": ("wandb", "metrics in Weights & Biases"),
}
"""Each extra: the package that tells whether it is installed, and what it adds."""


def facts() -> dict[str, str]:
    """Return what this machine has, a line of text for each name."""
    kinds = [each.device_kind for each in jax.local_devices()]
    free = shutil.disk_usage(Path.cwd()).free
    versions = {name: text for name, text in device.versions().items() if name != "device"}
    return {
        "python": platform.python_version(),
        **versions,
        "devices": ", ".join(f"{kinds.count(kind)} x {kind}" for kind in dict.fromkeys(kinds)),
        "cores": str(cores.count()),
        "memory": f"{bytes_available(jax.local_devices()) / 1e9:,.1f} GB available",
        "disk": f"{free / 1e9:,.1f} GB free in this folder",
        "temporary folder": tempfile.gettempdir(),
    }


def extras() -> dict[str, str | None]:
    """Return the installed version of each extra's package; None if it is not installed."""
    return {extra: _version(package) for extra, (package, _) in EXTRAS.items()}


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None
