"""Atomic files, either whole or absent.

A file is written under a temporary name and synced. Then it is renamed, and its folder is synced.

Only regular files are ever replaced. No link is followed in the folders of a run.
"""

import errno
import hashlib
import os
import shutil
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from itertools import takewhile
from pathlib import Path
from typing import Any

from primordia import interrupts
from primordia.errors import InputError, Trouble

READABLE = 2**26
"""Largest size, in bytes, of a file of settings or of a manifest."""
LONGEST_NAME = 240
"""Largest length of a name, in bytes. File systems allow 255, but an unfinished file's name has a
prefix."""
TEMPORARY = ".writing-"
"""Prefix of the names of unfinished files."""

KINDS: dict[int, str] = {
    stat.S_IFDIR: "a folder",
    stat.S_IFLNK: "a symbolic link",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}
"""Names of the kinds of paths that are not regular files."""


def is_plain(part: str) -> bool:
    """Return whether a part of a path is the name of a file on every system."""
    return part not in ("", ".", "..") and part.isprintable() and not set(part) & set('\\:*?"<>|')


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Raise Trouble, which names the path, if the `with` block fails to write (disk full, ...)."""
    try:
        yield
    except OSError as error:
        raise Trouble(f"{path} cannot be written: {error.strerror or error}") from None


def write(path: Path, fill: Callable[[Path], object], own: str = "") -> None:
    """Write the file `path`: `fill` writes a temporary file, which is then renamed.

    If several processes may write the file at once, each has its `own` name for the temporary file.

    Raises:
        InputError: the path exists and is not a regular file.
        Trouble: the file cannot be written (disk full, no permission, ...).
    """
    check_output(path)
    temporary = path.with_name(TEMPORARY + own + path.name)

    def undo() -> None:
        with suppress(OSError):
            temporary.unlink()

    with writing(path):
        # The temporary path could be a link, which `fill` would follow.
        temporary.unlink(missing_ok=True)
        with interrupts.undone_by(undo):
            fill(temporary)
            sync(temporary)
            temporary.rename(path)
            sync(path.parent)


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file with this content; see `write`."""
    write(path, lambda temporary: temporary.write_bytes(content))


def mark(path: Path) -> None:
    """Make an empty file at a free path, and wait until it is on the disk.

    Raises:
        Trouble: the file cannot be made.
    """
    with writing(path):
        path.touch(exist_ok=False)
        sync(path.parent)


def write_text(path: Path, text: str) -> None:
    """Write a text in UTF-8; see `write`."""
    write_bytes(path, text.encode())


def replace_text(path: Path, text: str) -> None:
    """Write a text in UTF-8 without waiting for the disk: readers see the old file or the new one.

    After a power cut the file may be damaged or missing. So use it only for content that can be
    computed again.

    Raises:
        Trouble: the file cannot be written.
    """
    temporary = path.with_name(TEMPORARY + path.name)
    with writing(path):
        temporary.unlink(missing_ok=True)  # it could be a link, which would be followed
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(path)


def check_output(path: Path) -> None:
    """Raise InputError unless the path is free or a regular file, which may be replaced."""
    if (kind := _kind(path)) is not None:
        raise InputError(f"{path} is {kind}, not a file; it was left unchanged")


def own_folder(path: Path) -> None:
    """Make a folder of a run, unless it exists. A link is refused, since it may lead out of the run.

    Raises:
        InputError: the path exists and is not a folder.
        Trouble: the folder cannot be made.
    """
    check_own_folder(path)
    if not path.is_dir():
        make_folder(path)


def check_own_folder(path: Path) -> None:
    """Raise InputError unless the path is free or a folder; a link may lead out of the run."""
    kind = _kind(path)
    if kind not in (None, KINDS[stat.S_IFDIR]):
        raise InputError(f"{path} is {kind}, not a folder; a run writes only into its own folders")


def make_folder(path: Path) -> None:
    """Make a folder and its missing parents, and wait until they are on the disk.

    Raises:
        InputError: no folder can have this name. Trouble: the folder cannot be made.
    """
    check_name(path)
    with writing(path):
        try:
            missing = takewhile(lambda each: not each.exists(), [path, *path.parents])
            for folder in reversed([path, *missing]):
                folder.mkdir(exist_ok=True)
                sync(folder.parent)
        except (FileExistsError, NotADirectoryError):
            wrong = f"{path} is not a folder, or leads through a file; name another"
            raise InputError(wrong) from None


def remove(path: Path) -> None:
    """Remove a file, a folder with its content, or a link (but not its target).

    Raises:
        Trouble: the path cannot be removed.
    """
    try:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink()
    except OSError as error:
        raise Trouble(f"{path} cannot be removed: {error.strerror or error}") from None


def _kind(path: Path) -> str | None:
    """Return the kind of a path, such as "a folder"; None if it is free or a regular file."""
    check_name(path)
    try:
        return KINDS.get(stat.S_IFMT(path.lstat().st_mode))
    except OSError:  # the path is free, or cannot be read; then writing it gives the error
        return None


def check_name(path: Path) -> None:
    """Raise InputError if a path is not in UTF-8, holds a NUL, or has a name that is too long.

    Libraries need UTF-8. Python represents other bytes by halves of surrogate pairs.
    """
    name = str(path)
    if "\0" in name or name != name.encode(errors="replace").decode():
        raise InputError(f"{name!r} is not in UTF-8 or holds a NUL; choose another name")
    if too_long := [part for part in path.parts if len(part.encode()) > LONGEST_NAME]:
        raise InputError(f"the file name {too_long[0][:40]}... is too long; give a shorter one")


def sync(path: Path) -> None:
    """Wait until a file or folder is on the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def read(path: Path) -> bytes:
    """Return the content of a regular file. Other kinds are refused: reading a pipe could block for
    ever.

    Raises:
        OSError: the file cannot be read, is not a regular file, or is larger than READABLE.
    """
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "not a regular file")
    if path.stat().st_size > READABLE:
        raise OSError(errno.EFBIG, "the file is too large")
    return path.read_bytes()


def sha256(path: Path) -> str:
    """Return the checksum of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def seal(path: Path) -> dict[str, Any]:
    """Return the size and the checksum of a file, as in manifests."""
    return {"bytes": path.stat().st_size, "sha256": sha256(path)}


def fault_in(path: Path, size: int, sha256: str) -> str | None:
    """Return the fault of a file that was sealed with this size and checksum, or None."""
    if not path.is_file():
        return f"{path} is missing"
    if path.stat().st_size != size:
        return f"{path} has {path.stat().st_size} bytes instead of {size}"
    if seal(path)["sha256"] != sha256:
        return f"{path} was changed or damaged: its checksum differs"
    return None
