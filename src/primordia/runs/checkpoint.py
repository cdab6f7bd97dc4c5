"""Checkpoints: the files that a run needs to go on. A crash at any instant leaves a good
checkpoint.

RUN/checkpoints/000012/state.npz        the state's arrays, and `tail.*`: rows in no segment yet
                       manifest.json    written last: checksums, the segments that count, progress

A fork begins at its own checkpoint, RUN/origin, which is never deleted.
"""

import os
import re
import shutil
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from primordia import files, interrupts
from primordia.errors import Trouble
from primordia.runs import manifest as manifests
from primordia.runs.arrays import Arrays, FaultOf
from primordia.runs.code import FOLDER as CODE
from primordia.runs.kept import FOLDER as FILES
from primordia.runs.manifest import INPUTS, Manifest, Progress, Seal
from primordia.runs.recorder import Recorder
from primordia.runs.schema import TABLES

KEPT = 2
"""Number of checkpoints that are kept; if the newest is damaged, the earlier one is used."""
FOLDER, ORIGIN = "checkpoints", "origin"
STATE, MANIFEST = "state.npz", "manifest.json"
NUMBER = re.compile("[0-9]{6,9}")
"""Names of checkpoints."""


FaultIn = Callable[[Path, int, str], str | None]
"""`files.fault_in`, or a version of it that remembers the files it has checked."""


@dataclass(frozen=True)
class Checkpoint:
    """A checkpoint with correct checksums."""

    path: Path
    manifest: Manifest

    def arrays(self, fault_of: FaultOf) -> Arrays:
        """Open the state and the tails; each array is checked when it is read."""
        return Arrays(self.path / STATE, fault_of)

    @property
    def digests(self) -> dict[str, np.ndarray]:
        """The sums of row hashes of each table, uint64 (W, 2)."""
        sums = self.manifest.digests
        return {table: np.array(each, np.uint64).reshape(-1, 2) for table, each in sums.items()}


def save(run: Path, arrays: dict[str, np.ndarray], recorder: Recorder, progress: Progress) -> None:
    """Write a checkpoint and remove old ones.

    Raises:
        Trouble: the checkpoint cannot be written; earlier checkpoints stay good.
    """
    number = 1 + max((int(path.name) for path in numbered(run)), default=-1)
    if not NUMBER.fullmatch(name := f"{number:06d}"):
        raise Trouble(f"{run / FOLDER} has no free number for another checkpoint")
    final = run / FOLDER / name
    write(run, final, arrays, recorder, progress)
    for old in numbered(run)[:-KEPT]:
        files.remove(old)


def write(
    run: Path,
    final: Path,
    arrays: dict[str, np.ndarray],
    recorder: Recorder,
    progress: Progress,
) -> None:
    """Write a checkpoint into the new folder `final`, such as RUN/origin; see `save`."""
    temporary = final.with_name(files.TEMPORARY + final.name)
    state, manifest = temporary / STATE, temporary / MANIFEST
    with files.writing(final):
        temporary.mkdir()
        with interrupts.undone_by(partial(shutil.rmtree, temporary, ignore_errors=True)):
            np.savez(state, allow_pickle=False, **arrays, **recorder.tails())
            files.sync(state)
            content = Manifest(
                progress=progress,
                inputs=_seals(run),
                state=Seal(**files.seal(state)),
                segments={table.name: table.segments for table in recorder.tables},
                digests={
                    name: [tuple(each) for each in digest.tolist()]
                    for name, digest in recorder.digests().items()
                },
            )
            manifest.write_text(content.text(), encoding="utf-8")
            files.sync(manifest)
            files.sync(temporary)
            temporary.rename(final)
            files.sync(final.parent)


def _seals(run: Path) -> dict[str, Seal]:
    """Return the seals of a run's inputs, by name: those of its newest checkpoint, if there is one.

    Inputs never change. A file that was edited while the run lives must not be approved.
    """
    for path in (*reversed(numbered(run)), run / ORIGIN):
        with suppress(OSError, ValueError):
            return manifests.read(path / MANIFEST).inputs
    return {name: Seal(**files.seal(run / name)) for name in _inputs(run)}


def _inputs(run: Path) -> list[str]:
    """Return the files that a run needs to go on, except checkpoints, by their path below the run."""
    held = (*(run / CODE).rglob("*.py"), *(run / FILES).rglob("*"))
    paths = [*(run / name for name in INPUTS), *sorted(path for path in held if path.is_file())]
    return [path.relative_to(run).as_posix() for path in paths if path.exists()]


def no_whole_checkpoint(run: Path, faults: list[str]) -> Trouble:
    """Return the error for a run without a whole checkpoint."""
    again = f"`primordia run {run / 'config.toml'}` repeats the run from its beginning"
    if (run / ORIGIN).exists():
        again = "fork it again"
    return Trouble(f"no checkpoint of {run} is whole: {faults[0]}; {again}")


def exists(run: Path) -> bool:
    """Return whether a run has a checkpoint, whole or not."""
    return (run / ORIGIN).exists() or bool(numbered(run))


def numbered(run: Path) -> list[Path]:
    """Return the folders of the run's checkpoints, oldest first.

    Raises:
        Trouble: the user may not read their folder.
    """
    try:
        names = os.listdir(run / FOLDER)
    except PermissionError as error:
        raise _unreadable(error) from None
    except OSError:
        return []
    return [run / FOLDER / name for name in sorted(filter(NUMBER.fullmatch, names), key=int)]


def _unreadable(error: OSError) -> Trouble:
    return Trouble(f"{error.filename} cannot be read: {error.strerror}")


def newest(run: Path, fault_in: FaultIn = files.fault_in) -> tuple[Checkpoint | None, list[str]]:
    """Return the newest whole checkpoint or None, and the fault of each newer checkpoint.

    A checkpoint is whole if its files and the segments that it names are unchanged.
    """
    faults: list[str] = []
    for result in _newest_first(run, fault_in):
        if isinstance(result, Checkpoint):
            return result, faults
        faults.append(result)
    return None, faults


def whole_checkpoints(run: Path, fault_in: FaultIn = files.fault_in) -> Iterator[Checkpoint]:
    """Yield the whole checkpoints, newest first, a fork's origin last."""
    return (result for result in _newest_first(run, fault_in) if isinstance(result, Checkpoint))


def origin(run: Path, fault_in: FaultIn = files.fault_in) -> Checkpoint | None:
    """Return the checkpoint that a fork began with; None if the run is no fork.

    Raises:
        Trouble: the checkpoint is damaged.
    """
    if not (run / ORIGIN).exists():
        return None
    result = _read(run, run / ORIGIN, fault_in)
    if isinstance(result, str):
        raise Trouble(result)
    return result


def _newest_first(run: Path, fault_in: FaultIn) -> Iterator[Checkpoint | str]:
    for path in reversed(numbered(run)):
        yield _read(run, path, fault_in)
    if (run / ORIGIN).exists():
        yield _read(run, run / ORIGIN, fault_in)


def _read(run: Path, path: Path, fault_in: FaultIn) -> Checkpoint | str:
    """Return a checkpoint, or its fault.

    Raises:
        Trouble: one of INPUTS has changed, so that no checkpoint can be used; or the user may not
            read the checkpoint.
    """
    try:
        manifest = manifests.read(path / MANIFEST)
        sealed: list[tuple[Path, Seal]] = [(path / STATE, manifest.state)]
        for table in TABLES:
            sealed += [(run / table / each.name, each) for each in manifest.segments[table]]
    except PermissionError as error:  # the checkpoint may be good, so no earlier one is used
        raise _unreadable(error) from None
    except (OSError, ValueError):
        return f"{path / MANIFEST} is missing or damaged"
    for name, seal in manifest.inputs.items():
        if fault := fault_in(run / name, seal.bytes, seal.sha256):
            raise Trouble(f"{fault}; put the file back (for other settings use `primordia fork`)")
    for file, seal in sealed:
        if fault := fault_in(file, seal.bytes, seal.sha256):
            return fault
    return Checkpoint(path, manifest)


def remove_leftovers(run: Path, last: Checkpoint | None) -> None:
    """Delete later and unfinished checkpoints, and segments that the given checkpoint does not name."""
    before = numbered(run)
    kept = before[: before.index(last.path) + 1] if last and last.path in before else []
    for path in (run / FOLDER).iterdir():
        if path not in kept:
            files.remove(path)
    for table in TABLES:
        named = {each.name for each in last.manifest.segments[table]} if last else set()
        for path in (run / table).iterdir():
            if path.name not in named:
                files.remove(path)
