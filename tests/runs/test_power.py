"""Promise 3 on a disk that forgets: the power may be cut between any two operations on files."""

import random
import shutil
from collections.abc import Iterator
from contextlib import nullcontext, suppress
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia import files
from primordia.errors import InputError
from primordia.runs import bundle, checkpoint, directory, loop, recorder
from primordia.runs.archive import Archive
from primordia.runs.arrays import world_ticks
from tests.disk import Disk, Instant
from tests.worlds import MILLS, config, digests_of

HALF, TICKS = 150, 300
SETTINGS: dict[str, Any] = {**MILLS, "stop": {"ticks": HALF}}


@dataclass
class Recorded:
    """A run that was begun, or forked, and resumed on a watched disk."""

    disk: Disk
    saved: list[tuple[int, int]]
    """number of operations and of ticks when each checkpoint was saved"""
    digests: list[str]

    def safe_ticks(self, operations: int) -> int:
        """Return the ticks of the newest checkpoint that this number of operations had saved."""
        return max((ticks for number, ticks in self.saved if number <= operations), default=-1)


@pytest.fixture(scope="module")
def small_segments() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(recorder, "SEGMENT_ROWS", 30)
        yield


def recorded(folder: Path, kind: str) -> Recorded:
    """Live a run, with many checkpoints: a new one, one with an ancestor, or a fork of another."""
    loop.start(config(SETTINGS), folder / "source")
    source = primordia.load(folder / "source")
    settings = config(SETTINGS, seed=2)
    if kind == "descendants":
        source.export(folder / "ancestor.safetensors", 0)
        settings = config(SETTINGS, ancestors=[str(folder / "ancestor.safetensors")])
    root = folder / "disk"
    root.mkdir()
    disk, run, saved = Disk(root), root / "some" / "run", list[tuple[int, int]]()
    with pytest.MonkeyPatch.context() as patch, disk.watched():
        patch.setattr(checkpoint, "save", noting(checkpoint.save, disk, saved))
        if kind == "fork":
            source.fork(HALF // 2, run, seed=7)
            saved.append((len(disk.instants), HALF // 2))
        else:
            loop.start(settings, run, checkpoint_every=0.0)
        loop.resume(run, {"ticks": TICKS}, checkpoint_every=0.0)
    assert len(saved) > 5
    return Recorded(disk, saved, digests_of(run))


def noting(save: Any, disk: Disk, saved: list[tuple[int, int]]) -> Any:
    """Return a function that saves a checkpoint, and notes when it has been saved."""

    def noted(run: Path, arrays: dict[str, Any], *rest: Any) -> None:
        save(run, arrays, *rest)
        saved.append((len(disk.instants), int(world_ticks(arrays).min())))

    return noted


@pytest.fixture(
    scope="module", params=["run", "fork", pytest.param("descendants", marks=pytest.mark.slow)]
)
def lived(
    request: pytest.FixtureRequest, small_segments: None, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Recorded]:
    result = recorded(tmp_path_factory.mktemp("power"), request.param)
    yield result
    result.disk.close()


def assert_goes_on(lived: Recorded, cut: int, how: str, folder: Path) -> None:
    """Assert that a run goes on after a cut: no checkpoint that was saved is lost, and no life."""
    lived.disk.left(lived.disk.instants[cut - 1], folder, how)
    run, safe = folder / "some" / "run", lived.safe_ticks(cut)
    if safe >= 0:
        assert Archive(run).ends.min() >= safe
    with suppress(InputError) if safe < 0 else nullcontext():  # nothing was promised yet
        loop.resume(run, {"ticks": TICKS})
        assert digests_of(run) == lived.digests
    shutil.rmtree(folder, ignore_errors=True)


def test_a_power_cut_loses_no_checkpoint_and_changes_no_life(
    lived: Recorded, tmp_path: Path
) -> None:
    draw, last = random.Random(1), len(lived.disk.instants)
    for number, cut in enumerate(draw.sample(range(1, last + 1), 9)):
        how = ["forgets", "names", f"chooses {number}"][number % 3]
        assert_goes_on(lived, cut, how, tmp_path / str(number))


@pytest.mark.parametrize("how", ["forgets", "names", "chooses 1"])
def test_a_start_that_was_cut_off_is_no_obstacle(lived: Recorded, tmp_path: Path, how: str) -> None:
    """What it has left is removed, and only that: no other files count as left by a start."""
    before_the_first = min(number for number, _ in lived.saved)
    for cut in range(1, before_the_first):
        lived.disk.left(lived.disk.instants[cut - 1], folder := tmp_path / str(cut), how)
        run = folder / "some" / "run"
        if directory.clear_unbegun(run):
            directory.refuse_if_taken(run)
        shutil.rmtree(folder)


def test_a_run_that_was_unpacked_is_whole_under_its_name(tmp_path: Path) -> None:
    """A cut before the end may leave a folder of another name."""
    loop.start(config(SETTINGS), tmp_path / "run")
    file = primordia.load(tmp_path / "run").bundle(tmp_path / "run.zip")
    (root := tmp_path / "disk").mkdir()
    disk = Disk(root)
    with disk.watched():
        bundle.unbundle(file, root / "run")
    for number, instant in enumerate(disk.instants):
        for how in ("forgets", "names", f"chooses {number}"):
            disk.left(instant, folder := tmp_path / f"{number} {how}", how)
            if (left := folder / "run").exists():
                assert digests_of(left) == digests_of(tmp_path / "run")
                assert Archive(left).versions == Archive(tmp_path / "run").versions
    assert (folder / "run").exists()
    disk.close()


@pytest.mark.slow
@pytest.mark.parametrize("how", ["forgets", "names", *(f"chooses {seed}" for seed in range(3))])
def test_the_power_may_be_cut_between_any_two_operations(
    lived: Recorded, tmp_path: Path, how: str
) -> None:
    for cut in range(1, len(lived.disk.instants) + 1):
        assert_goes_on(lived, cut, how, tmp_path / str(cut))


def in_use(instant: Instant, root: Path) -> Iterator[tuple[Path, int]]:
    """Yield the files that have their final names, with their inodes."""
    folders = [(root, root.stat().st_ino)]
    while folders:
        folder, inode = folders.pop()
        for name, each in instant.names.get(inode, {}).items():
            if name.startswith(files.TEMPORARY) or name == "lock":
                continue
            if each in instant.names:
                folders.append((folder / name, each))
            else:
                yield folder / name, each


def test_files_are_written_synced_renamed_and_their_folder_synced(lived: Recorded) -> None:
    """A file has its final name only when its whole content is on the disk, and never changes."""
    disk, before = lived.disk, dict[Path, tuple[int, bytes]]()
    for instant in disk.instants:
        now = {path: (each, instant.contents[each]) for path, each in in_use(instant, disk.root)}
        for path, (inode, content) in now.items():
            assert instant.safe_contents.get(inode) == content, f"{path} is not synced"
            was_there, old = before.get(path, (inode, content))
            assert was_there != inode or old == content, f"{path} was written in place"
        before = now
    for instant, following in pairwise(disk.instants):
        if instant.operation == "rename":
            assert (following.operation, following.path) == ("sync", instant.path.parent)
    renamed = {instant.path.name for instant in disk.instants if instant.operation == "rename"}
    assert {"config.toml", "versions.json", "000000.parquet", "000003"} <= renamed


def test_a_checkpoint_is_removed_only_when_two_newer_ones_are_safe(lived: Recorded) -> None:
    """So one damaged checkpoint costs time only, whenever the power is cut."""
    run = lived.disk.root / "some" / "run"
    folder, removed = (run / "checkpoints").stat().st_ino, set[str]()
    for instant in lived.disk.instants:
        name = instant.path.relative_to(lived.disk.root).parts[3:4]
        if instant.operation == "remove" and instant.path.parts[-3:-1] == ("checkpoints", *name):
            newer = [
                each for each in instant.safe_names[folder] if each.isdigit() and each > name[0]
            ]
            assert len(newer) >= checkpoint.KEPT
            removed.add(name[0])
    assert len(removed) >= 3
    assert len([*checkpoint.whole_checkpoints(run)]) >= checkpoint.KEPT
