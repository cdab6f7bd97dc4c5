"""What a run and its worker processes share: arrays, one row a cell, and words for each other."""

import mmap
import os
import tempfile
from pathlib import Path
from typing import BinaryIO

import numpy as np

Field = tuple[str, tuple[int, ...]]
"""dtype, and shape of one cell's part"""

READY = b"."
STEP, RESET, SAVE, LOAD = b"s", b"r", b"g", b"l"
"""What a worker is asked for, and its answer."""

ALIGNED = 64
"""bytes, a cache line"""


def size(fields: dict[str, Field], cells: int) -> int:
    """Bytes that arrays of these fields take."""
    return sum(_bytes(field, cells) for field in fields.values())


def arrays(memory: mmap.mmap, fields: dict[str, Field], cells: int) -> dict[str, np.ndarray]:
    """The arrays in a piece of memory, (cells, *shape) each."""
    found, start = {}, 0
    for name, (dtype, shape) in fields.items():
        count = cells * int(np.prod(shape))
        flat = np.frombuffer(memory, dtype, count, start)
        found[name] = flat.reshape(cells, *shape)
        start += _bytes((dtype, shape), cells)
    return found


def _bytes(field: Field, cells: int) -> int:
    dtype, shape = field
    wanted = cells * int(np.prod(shape)) * np.dtype(dtype).itemsize
    return -(-wanted // ALIGNED) * ALIGNED


def shared(size: int) -> tuple[BinaryIO, mmap.mmap]:
    """Memory that other processes can map by the file's descriptor; nothing is left when all close it.

    The file has no name, so not even kill -9 leaves one behind.
    """
    memory = Path("/dev/shm")
    where = memory if memory.is_dir() and os.access(memory, os.W_OK) else None
    file = tempfile.TemporaryFile(dir=where)  # noqa: SIM115
    file.truncate(size)
    return file, mmap.mmap(file.fileno(), size)
