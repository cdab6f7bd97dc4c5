"""Atomic files, either whole or absent: temporary name, fsync, rename, fsync of the folder."""

import hashlib
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from primordia.errors import Trouble

TEMPORARY = ".writing-"
"""Prefix of the names of unfinished files."""


def write(path: Path, fill: Callable[[Path], object]) -> None:
    """Write the file `path`: `fill` writes a temporary path, which is then renamed.

    Raises:
        Trouble: the file cannot be written (disk full, no permission, ...).
    """
    temporary = path.with_name(TEMPORARY + path.name)
    try:
        fill(temporary)
        sync(temporary)
        temporary.rename(path)
        sync(path.parent)
    except OSError as error:
        with suppress(OSError):
            temporary.unlink()
        raise Trouble(f"{path} cannot be written: {error.strerror or error}") from None


def make_folder(path: Path) -> None:
    """Make a folder and its missing parents, and wait until their names are on the disk."""
    if not path.is_dir():
        make_folder(path.parent)
        path.mkdir(exist_ok=True)
        sync(path.parent)


def sync(path: Path) -> None:
    """Wait until a file or folder is on the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def seal(path: Path) -> dict[str, object]:
    """Return size and checksum of a file, as manifests keep them."""
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    return {"bytes": path.stat().st_size, "sha256": digest}


def fault_in(path: Path, size: int, sha256: str) -> str | None:
    """Return the fault of a file that was sealed with this size and checksum, or None."""
    if not path.is_file():
        return f"{path} is missing"
    if path.stat().st_size != size:
        return f"{path} has {path.stat().st_size} bytes instead of {size}"
    if seal(path)["sha256"] != sha256:
        return f"{path} was changed or damaged: its checksum does not hold"
    return None
