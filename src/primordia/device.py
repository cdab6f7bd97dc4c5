"""What a run is computed by: instruction set, versions, device. Exactness holds within one of each."""

import os
import platform
from importlib.metadata import version
from pathlib import Path

from primordia.errors import InputError

PACKAGES = ("primordia", "jax", "jaxlib", "numpy")
ISA_FLAG = "--xla_cpu_max_isa"


def configure() -> None:
    """Prepare XLA; must run before JAX makes its first array.

    Vector instructions are held to AVX2, so that x86-64 machines with and without AVX-512 give
    the same bits (measured: no slower). A choice made in XLA_FLAGS stands.
    """
    flags = os.environ.get("XLA_FLAGS", "")
    if ISA_FLAG not in flags:
        os.environ["XLA_FLAGS"] = f"{flags} {ISA_FLAG}=AVX2".strip()


def select(name: str) -> None:
    """Compute on the named platform, `cpu` or `gpu`.

    Raises:
        InputError: JAX has no such device here.
    """
    import jax

    try:
        jax.config.update("jax_default_device", jax.devices(name)[0])  # type: ignore[no-untyped-call]
    except RuntimeError:
        raise InputError(f"--device: JAX finds no {name!r} device here") from None


def instruction_set() -> str:
    """Architecture, and the vector instructions XLA may use."""
    machine = platform.machine()
    if machine not in ("x86_64", "AMD64"):
        return machine
    allowed = os.environ.get("XLA_FLAGS", "").rpartition(ISA_FLAG + "=")[2].split(" ")[0]
    cpu = Path("/proc/cpuinfo")
    has_avx2 = "avx2" in cpu.read_text() if cpu.exists() else True
    return f"{machine} {allowed or 'native'}" + ("" if has_avx2 else " (this machine has no AVX2)")


def versions() -> dict[str, str]:
    """What must be equal for a run to go on bit for bit."""
    import jax

    default = getattr(jax.config, "jax_default_device", None) or jax.devices()[0]
    return {
        **{name: version(name) for name in PACKAGES},
        "device": default.device_kind if default.platform != "cpu" else "cpu",
        "instruction_set": instruction_set(),
    }
