"""The board that a run and its worker processes share: arrays with a row for each cell, and commands."""

import mmap
import os
import tempfile
from pathlib import Path
from typing import BinaryIO

import numpy as np

from primordia.errors import Trouble

Field = tuple[str, tuple[int, ...]]
"""dtype and shape of an array for one cell"""

STEP, RESET, SAVE, LOAD = b"s", b"r", b"g", b"l"
"""Commands to a worker."""
READY = b"."
"""A worker's answer to a command."""

ALIGNMENT = 64
"""bytes, a cache line"""


_reserve = getattr(os, "posix_fallocate", lambda file, _, size: os.ftruncate(file, size))
"""`posix_fallocate`, which macOS does not have"""


def size(fields: dict[str, Field], cells: int) -> int:
    """Return the size of arrays of these fields, in bytes."""
    return sum(_bytes(field, cells) for field in fields.values())


def arrays(memory: mmap.mmap, fields: dict[str, Field], cells: int) -> dict[str, np.ndarray]:
    """Return the arrays in a block of memory, each (cells, *shape)."""
    views, start = {}, 0
    for name, (dtype, shape) in fields.items():
        count = cells * int(np.prod(shape))
        flat = np.frombuffer(memory, dtype, count, start)
        views[name] = flat.reshape(cells, *shape)
        start += _bytes((dtype, shape), cells)
    return views


def _bytes(field: Field, cells: int) -> int:
    dtype, shape = field
    used = cells * int(np.prod(shape)) * np.dtype(dtype).itemsize
    return -(-used // ALIGNMENT) * ALIGNMENT


def shared_memory(size: int) -> tuple[BinaryIO, mmap.mmap]:
    """Return a file and its memory, which other processes can map by the file's descriptor.

    The file has no name, so nothing is left when all its processes have ended, even by kill -9.
    """
    in_memory = Path("/dev/shm")
    usable = in_memory.is_dir() and os.access(in_memory, os.W_OK)
    for folder in (in_memory, None) if usable else (None,):
        file = tempfile.TemporaryFile(dir=folder)  # noqa: SIM115
        try:
            # Without room for all of it, a process would be killed when it first writes there.
            _reserve(file.fileno(), 0, size)
        except OSError:
            file.close()
            continue
        return file, mmap.mmap(file.fileno(), size)
    raise Trouble(
        f"no room for the {size:,} bytes that simulators share, neither in {in_memory} nor in"
        f" {tempfile.gettempdir()}; free space, or choose fewer cells"
    )
