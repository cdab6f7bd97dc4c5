"""Compiled code that commands keep on disk, so that a second run of a task starts in seconds."""

import hashlib
import os
import platform
import warnings
from pathlib import Path

import click
from platformdirs import user_cache_path

CPUINFO = Path("/proc/cpuinfo")
FEATURES = ("model name", "flags", "CPU implementer", "CPU part", "Features")
"""Lines of CPUINFO on which compiled code depends."""
LARGEST = 2**30
"""Bytes that compiled code may take; what has not been used for longest is then removed."""


def keep_compiled_code() -> None:
    """Tell JAX where to keep compiled code, unless the environment does; call it before JAX is imported.

    Processors of different kinds have their own folders, since a home folder may be shared by machines
    and code compiled for one may crash another.
    """
    folder = user_cache_path("primordia", appauthor=False) / "compiled" / processor()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:  # a home folder that cannot be written
        return
    # A full disk costs the next run some seconds; it is not worth a warning.
    warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation")
    os.environ.setdefault("JAX_COMPILATION_CACHE_DIR", str(folder))
    os.environ.setdefault("JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS", "0.2")
    os.environ.setdefault("JAX_COMPILATION_CACHE_MAX_SIZE", str(LARGEST))


def processor(cpuinfo: Path = CPUINFO) -> str:
    """Return a name for the kind of this machine's processor and the instructions that it has."""
    try:
        first = cpuinfo.read_text(encoding="utf-8").split("\n\n")[0]
        about = [line for line in first.splitlines() if line.startswith(FEATURES)]
    except OSError:
        about = [platform.processor()]
    text = "\n".join([platform.machine(), *about])
    return f"{platform.machine()}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"


def _compile_again(_: click.Context, __: click.Parameter, given: bool) -> None:
    if given:
        os.environ["JAX_ENABLE_COMPILATION_CACHE"] = "false"


cache_option = click.option(
    "--no-cache",
    is_flag=True,
    expose_value=False,
    callback=_compile_again,
    help="Compile everything; neither use nor keep compiled code.",
)
