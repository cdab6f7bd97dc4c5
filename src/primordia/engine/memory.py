"""The memory that the arrays of a run need, computed from their shapes before they are made."""

import os
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import jax
import jax.numpy as jnp

from primordia.errors import InputError
from primordia.habitats.bodies import placeholder_bodies
from primordia.habitats.contract import AnyHabitat
from primordia.law.events import empty
from primordia.law.genesis import empty_worlds
from primordia.law.law import Law
from primordia.random.wide import zero

MEMINFO, CGROUP = Path("/proc/meminfo"), Path("/sys/fs/cgroup/memory.max")
"""The file in which Linux shows the available memory, and the file with a container's memory limit."""


def check(law: Law, habitat: AnyHabitat, devices: list[jax.Device]) -> None:
    """Raise InputError if the devices have less memory than the arrays of a run need."""
    needed, available = bytes_needed(law, habitat, len(devices)), bytes_available(devices)
    if needed > available:
        cells = law.worlds * law.cells
        raise InputError(
            f"cells x seeds: {cells:,} cells need {_gigabytes(needed)} of memory or more,"
            f" {_gigabytes(available)} are available; choose fewer cells, fewer seeds or a smaller"
            " brain"
        )


def bytes_needed(law: Law, habitat: AnyHabitat, devices: int = 1) -> int:
    """Return the bytes that a run needs on all devices: worlds, event lists, and bodies or senses."""
    law = replace(law, worlds=law.worlds // devices)
    cells = law.worlds * law.cells

    def arrays() -> object:
        if habitat.kind == "jax":
            bodies = placeholder_bodies(habitat, cells)
        else:
            bodies = jnp.zeros((cells, habitat.senses_size), jnp.float32)
        seeds = zero((law.worlds,))
        return empty_worlds(law, seeds, jnp), bodies, empty(law, jnp)

    leaves = jax.tree.leaves(jax.eval_shape(arrays))
    return devices * sum(leaf.size * leaf.dtype.itemsize for leaf in leaves)


def bytes_available(devices: list[jax.Device]) -> int:
    """Return the bytes of memory that all devices offer together if each takes an equal share."""
    known = [statistics for device in devices if (statistics := device.memory_stats())]
    if known:
        return len(known) * min(int(each["bytes_limit"] - each["bytes_in_use"]) for each in known)
    amounts = [os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")]
    with suppress(OSError, ValueError):  # systems other than Linux: no limit
        amounts.append(int(CGROUP.read_text(encoding="utf-8")))
    with suppress(OSError, ValueError):
        lines = dict(
            line.split(":", 1) for line in MEMINFO.read_text(encoding="utf-8").splitlines()
        )
        amounts.append(int(lines["MemAvailable"].split()[0]) * 1024)
    return min(amounts)


def _gigabytes(count: int) -> str:
    return f"{count / 1e9:,.1f} GB"
