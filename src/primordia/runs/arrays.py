"""The arrays of a checkpoint: a state by name, and the open tails of the tables."""

import io
import sys
import zipfile
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.lib import format as npy

from primordia.errors import Trouble

NEVER = 2**64 - 1
"""The value for the tick or count of an event that has not happened."""

WORLDS = "world.worlds."
"""Prefix of the names of arrays with a row for each world, not for each cell."""
NPY = ".npy"
SMALL = 2**20
"""Largest size, in bytes, of a file that is read at once."""
FaultOf = Callable[[str, np.ndarray], str | None]
"""A function of name and array that returns a fault, or None."""


class Arrays(Mapping[str, np.ndarray]):
    """State and open tails of a checkpoint by name, each read and checked at its first use.

    The arrays can be read even after the run has gone on and removed the file. A small file is read
    at opening, since an arm may have thousands of runs, and a process can keep only about a
    thousand files open. A large file stays open. The arrays are read-only.
    """

    def __init__(self, file: Path, fault_of: FaultOf) -> None:
        """Open a file; raise Trouble if it holds no arrays."""
        self._file, self._fault_of = file, fault_of
        try:
            small = file.stat().st_size <= SMALL
            self._archive = zipfile.ZipFile(io.BytesIO(file.read_bytes()) if small else file)
            self._sizes = _sizes(self._archive, file.stat().st_size)
        except FileNotFoundError:
            raise Trouble(
                f"{file} is gone: the run has gone on meanwhile and keeps newer checkpoints; try again"
            ) from None
        except Exception:  # zipfile raises errors of many kinds for other files
            raise self._damaged() from None
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._sizes:
            raise KeyError(name)
        if name not in self._read:
            try:
                array = _array(self._archive.read(name + NPY))
            except Exception:  # zipfile and NumPy raise errors of many kinds
                raise self._damaged() from None
            if fault := self._fault_of(name, array):
                raise self.unfit(fault)
            self._read[name] = array
        return self._read[name]

    def __contains__(self, name: object) -> bool:
        return name in self._sizes

    def __iter__(self) -> Iterator[str]:
        return iter(self._sizes)

    def __len__(self) -> int:
        return len(self._sizes)

    def size(self, name: str) -> int:
        """Return the number of bytes that an array takes in the file; the array is not read."""
        return self._sizes[name]

    def unfit(self, fault: str) -> Trouble:
        """Return the error for arrays that do not fit their run."""
        return Trouble(f"{self._file.parent} is not a checkpoint of this run: {fault}")

    def _damaged(self) -> Trouble:
        return Trouble(
            f"{self._file} is damaged: it is not an archive of arrays; restore it from a copy"
        )


def _sizes(archive: zipfile.ZipFile, most: int) -> dict[str, int]:
    """Return the size of each array in bytes; raise ValueError if the file, of `most` bytes, cannot
    hold the arrays."""
    entries = archive.infolist()
    # A small file could hold compressed arrays, or overlapping ones, of many gigabytes.
    stored = all(each.compress_type == zipfile.ZIP_STORED for each in entries)
    if not stored or sum(each.file_size for each in entries) > most:
        raise ValueError("the arrays are compressed, or larger than their file")
    # Runs of the same arm share the names.
    return {sys.intern(each.filename.removesuffix(NPY)): each.file_size for each in entries}


def _array(content: bytes) -> np.ndarray:
    """Return the array of a file in NumPy's format; NumPy's own reader takes ten times as long."""
    length = 10 + int.from_bytes(content[8:10], "little")
    shape, by_columns, dtype = _header(content[:length])
    array = np.frombuffer(content, dtype, offset=length)
    return array.reshape(shape, order="F" if by_columns else "C")


@lru_cache(maxsize=1024)
def _header(content: bytes) -> tuple[tuple[int, ...], bool, np.dtype]:
    """Return the content of a header of NumPy's format 1.0; many arrays have equal headers."""
    file = io.BytesIO(content)
    if npy.read_magic(file) != (1, 0):
        raise ValueError
    return npy.read_array_header_1_0(file)


def read_count(arrays: Mapping[str, np.ndarray], name: str) -> np.ndarray:
    """Return 64-bit numbers, which a state holds in two words, as uint64."""
    hi, lo = arrays[f"{name}.hi"].astype(np.uint64), arrays[f"{name}.lo"]
    return (hi << np.uint64(32)) | lo


def world_ticks(arrays: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the ticks that each world of a state has lived through, uint64 (W,)."""
    return read_count(arrays, "world.worlds.tick")
