"""Set-up of all tests: JAX, Hypothesis, and a shared cache of compiled code."""

import hashlib
import os
import platform
from pathlib import Path

import jax
import pytest
from hypothesis import HealthCheck, settings

from primordia import device
from tests import commands

# XLA compiles faster with its older emitters. Their code is slower and gives the same bits: the digests
# in these tests were made with the new emitters.
EMITTERS = "--xla_cpu_use_fusion_emitters"
flags = os.environ.get("XLA_FLAGS", "")
if EMITTERS not in flags:
    os.environ["XLA_FLAGS"] = f"{flags} {EMITTERS}=false".strip()
device.prepare()
# Processes that tests start, and workers that those start, import this tree, whatever is installed.
os.environ["PYTHONPATH"] = commands.TREE

# A slow test is not a wrong test: the machine may be busy, and garbage collection takes up to 0.3 s.
settings.register_profile("patient", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("patient")


@pytest.fixture(autouse=True, scope="session")
def _compiled_code(tmp_path_factory: pytest.TempPathFactory, pytestconfig: pytest.Config) -> None:
    """Share one cache of compiled code among test processes, the commands they run, and later tests.

    It is in pytest's own cache, in a folder for each kind of processor, or else among temporary files.
    """
    root = tmp_path_factory.getbasetemp()
    shared = root.parent if root.name.startswith("popen") else root
    kept = getattr(pytestconfig, "cache", None)
    commands.CACHE = kept.mkdir(f"compiled-{processor()}") if kept else Path(shared) / "compiled"
    jax.config.update("jax_compilation_cache_dir", str(commands.CACHE))
    jax.config.update("jax_compilation_cache_max_size", 2**31)
    os.environ["XDG_STATE_HOME"] = str(shared / "state")
    os.environ["XDG_CACHE_HOME"] = str(shared / "cache")
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.2)


def processor() -> str:
    """Return a name for this machine's kind of processor; code compiled for another may not run."""
    file = Path("/proc/cpuinfo")
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    about = {line for line in lines if line.startswith(("model name", "flags", "Features"))}
    return hashlib.sha256("\n".join([platform.machine(), *sorted(about)]).encode()).hexdigest()[:12]
