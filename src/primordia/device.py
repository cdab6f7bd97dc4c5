"""The device, the instruction set and the versions that a run depends on.

If all three are equal, the results are equal to the last bit.
"""

import os
import platform
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, suppress
from contextvars import ContextVar
from functools import cache
from importlib.metadata import version
from pathlib import Path

import jax
import jax.numpy as jnp

from primordia import cores
from primordia.errors import InputError

PACKAGES = ("primordia", "jax", "jaxlib", "numpy")
CPU = "cpu"
ISA_FLAG = "--xla_cpu_max_isa"
UNOPTIMISED = "jax_disable_most_optimizations"
SAME_BITS = ("--xla_dump", "--xla_force_host_platform_device_count")
"""Prefixes of XLA's flags that change no bit of a result. Any other flag may change bits."""


def prepare() -> None:
    """Set up JAX for runs, unless it has started. Call this before JAX makes an array.

    XLA is limited to AVX2, so that x86-64 machines with and without AVX-512 give the same bits
    (measured: no slower). A limit that is already in XLA_FLAGS is kept. XLA reads the flag once in
    a process, and ignores the flag as a compiler option of `jax.jit`. If the program has already used
    JAX, nothing is changed, and the run records the instruction set that XLA_FLAGS allow.

    Raises:
        InputError: XLA_FLAGS names a file, or JAX_PLATFORMS allows no device of this machine.
    """
    if started():
        return
    cores.limit_threads()
    flags = os.environ.get("XLA_FLAGS", "").strip()
    if flags and not flags.startswith("-"):
        raise InputError(f"XLA_FLAGS: {flags} names a file; put its flags into the variable itself")
    if ISA_FLAG not in flags:
        # The flag stays set: by this flag JAX's cache tells code compiled for AVX2 from other code.
        os.environ["XLA_FLAGS"] = f"{flags} {ISA_FLAG}=AVX2".strip()
    # A small call is computed by the thread that makes it. Passing it to another thread would cost
    # a third of the time of a tick. JAX reads this option when it starts.
    name = "jax_cpu_enable_async_dispatch"
    before = jax.config.read(name)
    jax.config.update(name, False)
    try:
        jax.devices()
    except (AssertionError, RuntimeError):  # JAX raises both
        if (wanted := os.environ.get("JAX_PLATFORMS")) is None:
            raise
        raise InputError(
            f"JAX finds no device that the variable JAX_PLATFORMS={wanted} allows; unset the variable"
        ) from None
    finally:
        jax.config.update(name, before)


def started() -> bool:
    """Return whether JAX has started: from then on it refuses another number of CPU devices.

    JAX has no public function that tells.
    """
    name = "jax_num_cpu_devices"
    before = getattr(jax.config, name)
    try:
        jax.config.update(name, before + 1)
    except RuntimeError:
        return True
    jax.config.update(name, before)
    return False


_CHOSEN: ContextVar[bool] = ContextVar("chosen", default=False)
"""Whether the device was chosen by name, so the devices of runs do not matter."""


@contextmanager
def selected(name: str | None, made_on: str = CPU) -> Iterator[None]:
    """Compute on a platform, or on the device of a run, in a `with` block.

    Args:
        name: `cpu` or `gpu`; None: the device of the run, unless a block around this one has chosen
            a platform by name.
        made_on: the recorded device of the run, as in `versions`.

    Raises:
        InputError: JAX has no such device here.
    """
    prepare()
    if name is None and _CHOSEN.get():
        yield
        return
    first = _first(made_on if name is None else name)
    if first is None and name is not None:
        raise InputError(f"--device: JAX finds no {name!r} device on this machine")
    if first is None:
        raise InputError(
            f"the run was made on {made_on}, which JAX does not find on this machine, and other devices"
            " give other bits; use a machine that has it, or choose another device with --device cpu"
        )
    token = _CHOSEN.set(name is not None)
    try:
        # Code compiled outside a block that changes nothing is used inside it, too.
        with nullcontext() if first == default() else jax.default_device(first):
            yield
    finally:
        _CHOSEN.reset(token)


def _first(wanted: str) -> jax.Device | None:
    """Return the first device of a platform or of a kind, or None."""
    for platform_name in (CPU, "gpu", "tpu"):
        with suppress(RuntimeError):  # JAX has no such platform here
            for each in jax.local_devices(backend=platform_name):
                if wanted in (platform_name, _kind(each)):
                    return each
    return None


def default() -> jax.Device:
    """Return the device that JAX computes on by default."""
    prepare()
    (device,) = jnp.zeros(()).devices()
    return device


def sharing(worlds: int) -> list[jax.Device]:
    """Return the devices that share a run's worlds: the default device, and others of its kind.

    All devices take the same number of worlds. So the number of devices is the largest divisor of
    `worlds` for which there are enough devices.
    """
    first = default()
    alike = [
        each
        for each in jax.local_devices(backend=first.platform)
        if each.device_kind == first.device_kind
    ]
    devices = [first, *(each for each in alike if each != first)]
    most = max(n for n in range(1, len(devices) + 1) if worlds % n == 0)
    return devices[:most]


def instruction_set() -> str:
    """Return the architecture, the limit of XLA's vector instructions, and flags that may change bits."""
    flags = os.environ.get("XLA_FLAGS", "").split()
    others = sorted(flag for flag in flags if not flag.startswith((ISA_FLAG, *SAME_BITS)))
    # Without optimisations XLA's tanh has other bits.
    if jax.config.values.get(UNOPTIMISED):
        others.append(UNOPTIMISED)
    machine = platform.machine()
    if machine not in ("x86_64", "AMD64"):
        return " ".join([machine, *others])
    limits = [flag.partition("=")[2] for flag in flags if flag.startswith(ISA_FLAG)]
    cpu = Path("/proc/cpuinfo")
    has_avx2 = "avx2" in cpu.read_text(encoding="utf-8") if cpu.exists() else True
    lacks = [] if has_avx2 else ["(this machine has no AVX2)"]
    return " ".join([machine, limits[-1] if limits else "native", *lacks, *others])


def versions() -> dict[str, str]:
    """Return the versions, device and instruction set that must be equal for a run to go on exactly."""
    return {
        **_packages(),
        "device": _kind(default()),
        "instruction_set": instruction_set(),
    }


@cache
def _packages() -> dict[str, str]:
    """Return the versions of PACKAGES, whose files are read once in a process."""
    return {name: version(name) for name in PACKAGES}


def _kind(device: jax.Device) -> str:
    return CPU if device.platform == CPU else device.device_kind
