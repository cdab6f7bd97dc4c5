"""Disks on which a run cannot be written."""

import errno
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest

from primordia import files
from primordia.errors import Trouble
from primordia.runs import checkpoint, loop
from tests.commands import complains, here
from tests.trouble import SMALL, TICKS, contents, digest, goes_on, started


def test_a_place_where_no_run_can_be_made_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("mine")
    below = here("run", *SMALL, "--ticks", "10", "--out", file / "run")
    complains(below, 2, str(file / "run"), "leads through a file; name another")
    nowhere = here("run", *SMALL, "--ticks", "10", "--out", "/proc/run")
    complains(nowhere, 1, "/proc/run", "cannot be written")
    assert file.read_text() == "mine"


def test_a_run_without_write_permission_is_an_error(
    run: Path, through: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = contents(run)
    with monkeypatch.context() as patch:
        patch.setattr(os, "open", refusing(os.open, run))
        complains(here("resume", run), 1, str(run), "cannot be written", "Permission denied")
        assert here("info", run).returncode == 0
    assert contents(run) == before
    goes_on(run, through)


def refusing(real_open: Callable[..., int], below: Path) -> Callable[..., int]:
    """Return an `os.open` that refuses to write below a path."""

    def refuse(path: str, flags: int, *rest: Any, **named: Any) -> int:
        if flags & (os.O_WRONLY | os.O_RDWR) and str(path).startswith(str(below)):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return real_open(path, flags, *rest, **named)

    return refuse


class Disk:
    """A disk that is full from the n-th write on, for every function that writes."""

    def __init__(self, patch: pytest.MonkeyPatch, writes: int) -> None:
        self.left, self.writes = writes, 0
        patch.setattr(np, "savez", self.limited(np.savez))
        patch.setattr(pyarrow.parquet, "write_table", self.limited(pyarrow.parquet.write_table))
        patch.setattr(files, "sync", self.limited(files.sync))
        for name in ("write_text", "rename", "mkdir"):
            patch.setattr(Path, name, self.limited(getattr(Path, name)))

    def limited(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def write(*args: Any, **named: Any) -> Any:
            if named.get("exist_ok"):
                return real(*args, **named)
            self.writes += 1
            if self.writes > self.left:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return real(*args, **named)

        return write


@pytest.mark.slow
def test_after_a_full_disk_at_any_write_a_run_can_be_resumed(
    half: Path, through: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def tried(writes: int, run: Path) -> int:
        with monkeypatch.context() as patch:
            disk = Disk(patch, writes)
            loop.resume(run, {"ticks": TICKS}, checkpoint_every=0.0)
        return disk.writes

    def copy(name: object) -> Path:
        return Path(shutil.copytree(half, tmp_path / str(name)))

    needed = tried(10**9, copy("enough"))
    assert digest(tmp_path / "enough") == through
    assert needed >= 3 * 8 + 3 * 4, "some checkpoints, and the last segment of each table"
    for writes in range(needed):
        run = copy(writes)
        with pytest.raises(Trouble, match=f"{run}/.* cannot be written: No space left on device"):
            tried(writes, run)
        goes_on(run, through)
        shutil.rmtree(run)


def test_a_disk_that_is_full_from_the_beginning_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for writes in range(12):
        with monkeypatch.context() as patch:
            Disk(patch, writes)
            with pytest.raises(Trouble, match="cannot be written: No space left on device"):
                started(tmp_path / str(writes))
        assert not list(tmp_path.iterdir()), "a start that fails leaves nothing"


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """Mount a file system with room for one checkpoint and a half."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=128k", "tmpfs", str(folder)]
    if os.getuid() != 0 or shutil.which("mount") is None:
        pytest.skip("needs root, to mount a small file system")
    if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        pytest.skip("no file system can be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_after_a_real_full_disk_a_run_can_be_resumed(small_disk: Path, through: str) -> None:
    run, often = small_disk / "run", ("--checkpoint-every", "0")
    done = here("run", *SMALL, "--ticks", TICKS, "--out", run, *often)
    complains(done, 1, str(run), "cannot be written", "No space left on device")
    assert checkpoint.numbered(run), "the disk was full before there was a checkpoint"
    assert here("info", run).returncode == 0
    complains(here("resume", run, "--quiet", *often), 1, "No space left on device")
    subprocess.run(["mount", "-o", "remount,size=20m", str(small_disk)], check=True)
    goes_on(run, through)
