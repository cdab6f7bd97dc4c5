"""A disk that forgets: what a power cut may leave of a folder, between any two operations on its files.

Nothing is promised of a file's content before the file is synced, nor of a name before its folder is.
"""

import os
import random
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from unittest.mock import patch

Names = dict[int, dict[str, int]]
"""inode of a folder -> name -> inode"""
Contents = dict[int, bytes]
"""inode of a file -> content"""


@dataclass(frozen=True)
class Instant:
    """The disk after one operation: what was synced, and what processes see."""

    operation: str
    """`sync`, `rename`, `mkdir` or `remove`; `write`: all that was written before the next of these"""
    path: Path
    """the file or folder that it concerns, under its new name if it was renamed"""
    safe_names: Names
    safe_contents: Contents
    names: Names
    contents: Contents


@dataclass
class Disk:
    """A folder whose disk is watched. Only operations of this process through `os` are seen as such."""

    root: Path
    instants: list[Instant] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._held: dict[int, int] = {}
        self._folders: set[int] = set()
        self._inode = self.root.stat().st_ino
        names, contents = self._seen()
        self._safe_names, self._safe_contents = self._last = names, contents

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Record an instant after each operation of a `with` block on files below the root."""
        with patch.multiple(
            os,
            fsync=self._noted("sync", os.fsync),
            rename=self._noted("rename", os.rename),
            replace=self._noted("rename", os.replace),
            mkdir=self._noted("mkdir", os.mkdir),
            unlink=self._noted("remove", os.unlink),
            remove=self._noted("remove", os.remove),
            rmdir=self._noted("remove", os.rmdir),
        ):
            yield

    def close(self) -> None:
        """Release the files that were held open."""
        for handle in self._held.values():
            os.close(handle)

    def _noted(self, name: str, real: Callable[..., None]) -> Callable[..., None]:
        def operate(*args: Any, **named: Any) -> None:
            path = self._path(args, named)
            below = path == self.root or self.root in path.parents
            if below and self._seen() != self._last:
                self._note("write", path)
            real(*args, **named)
            if below:
                self._note(name, path)

        return operate

    def _path(self, args: tuple, named: dict[str, Any]) -> Path:
        if isinstance(args[0], int):
            return Path(os.readlink(f"/proc/self/fd/{args[0]}"))
        path = Path(args[-1] if len(args) == 2 and not isinstance(args[-1], int) else args[0])
        if (folder := named.get("dir_fd")) is not None:
            path = Path(os.readlink(f"/proc/self/fd/{folder}")) / path
        return path

    def _note(self, name: str, path: Path) -> None:
        names, contents = self._last = self._seen()
        if name == "sync":
            inode = path.stat().st_ino
            if inode in names:
                self._safe_names = {**self._safe_names, inode: names[inode]}
            else:
                self._safe_contents = {**self._safe_contents, inode: contents[inode]}
        safe = self._safe_names, self._safe_contents
        self.instants.append(Instant(name, path, *safe, names, contents))

    def _seen(self) -> tuple[Names, Contents]:
        names: Names = {}
        contents: Contents = {}
        folders = [self.root]
        while folders:
            folder = folders.pop()
            inside = names[folder.stat().st_ino] = {}
            self._folders.add(folder.stat().st_ino)
            for path in folder.iterdir():
                inode = inside[path.name] = path.stat().st_ino
                if inode not in self._held:  # held open, so that no number is used twice
                    self._held[inode] = os.open(path, os.O_RDONLY)
                if path.is_dir():
                    folders.append(path)
                else:
                    contents[inode] = path.read_bytes()
        return names, contents

    def left(self, instant: Instant, to: Path, how: str) -> None:
        """Write what a power cut after an instant leaves.

        Args:
            instant: the last operation before the cut.
            to: a new folder.
            how: `forgets`: nothing but what was synced; `names`: all names, but no content that was not
                synced; else the seed of a choice for each folder and file.
        """
        draw = random.Random(how)

        def write(inode: int, path: Path) -> None:
            content, now = instant.safe_contents.get(inode, b""), instant.contents.get(inode, b"")
            if how not in ("forgets", "names") and content != now:
                content = draw.choice([content, now, now[: len(now) // 2]])
            path.write_bytes(content)

        def fill(inode: int, folder: Path) -> None:
            folder.mkdir()
            safe, now = instant.safe_names.get(inode, {}), instant.names.get(inode, {})
            either = draw.choice([safe, now])
            for name, each in {"forgets": safe, "names": now}.get(how, either).items():
                (fill if each in self._folders else write)(each, folder / name)

        fill(self._inode, to)
