"""JAX's variables: the cache of compiled code on disk, with which a second run starts in seconds."""

import hashlib
import os
import platform
import warnings
from pathlib import Path

from platformdirs import user_cache_path

from primordia.errors import InputError

CPUINFO = Path("/proc/cpuinfo")
FEATURES = ("model name", "flags", "CPU implementer", "CPU part", "Features")
"""Lines of CPUINFO on which compiled code depends."""
LARGEST = 2**30
"""Largest size of the cache in bytes; the least recently used code is removed first."""


def prepare_jax() -> None:
    """Set JAX's variables for a command, and check those that the user has set. Call this before
    importing JAX.

    JAX reads its variables when it is imported. It takes a while to load, so it is imported here only
    if the user has set one of its variables.

    Raises:
        InputError: JAX refuses the value of a variable.
    """
    given = any(name.startswith("JAX_") for name in os.environ)
    keep_compiled_code()
    if not given:
        return
    try:
        import jax  # noqa: F401
    except ValueError as error:
        raise InputError(f"JAX does not start: {error}; correct or unset this variable") from None


def keep_compiled_code() -> None:
    """Set JAX's folder for compiled code, unless the environment sets it.

    Each kind of processor has a separate folder. Machines may share a home folder, and code that
    was compiled for one machine may crash on another.
    """
    try:
        folder = user_cache_path("primordia", appauthor=False) / "compiled" / processor()
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, RuntimeError):  # the home folder cannot be written, or is unknown
        return
    # A full disk only slows the start of the next run, so no warning is shown.
    warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation")
    os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(folder))
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.05")
    os.environ.setdefault("JAX_COMPILATION_CACHE_MAX_SIZE", str(LARGEST))


def processor(cpuinfo: Path = CPUINFO) -> str:
    """Return a name for this machine's kind of processor and its instruction set."""
    try:
        first = cpuinfo.read_text(encoding="utf-8").split("\n\n")[0]
        about = [line for line in first.splitlines() if line.startswith(FEATURES)]
    except OSError:
        about = [platform.processor()]
    text = "\n".join([platform.machine(), *about])
    return f"{platform.machine()}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"
