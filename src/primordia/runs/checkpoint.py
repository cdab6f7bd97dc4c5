"""Checkpoints: all that is needed to go on, written so that a crash at any instant leaves a good one.

RUN/checkpoints/000012/state.npz        the state's arrays, and `tail.*`: rows in no segment yet
                       manifest.json    written last: checksums, the segments that count, progress

A fork begins at a checkpoint of its own, RUN/origin, which stays.
"""

import hashlib
import json
import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from primordia import files
from primordia.brains.genomes import FOUNDERS
from primordia.errors import Trouble
from primordia.runs.record import Recorder
from primordia.runs.schema import TABLES

KEPT = 2
"""Checkpoints kept; should the newest be damaged, the one before serves."""
ORIGIN = "origin"
INPUTS = ("config.toml", FOUNDERS)
"""What a run cannot go on without, beside its checkpoints."""


@dataclass
class Progress:
    """What a manifest says of the run as a whole."""

    limits: dict[str, Any]
    """ticks, births, until: as last asked for"""
    wall_s: float
    """seconds spent so far"""
    exact: bool
    """whether all of it can be repeated bit for bit"""


NEVER = 2**64 - 1
"""A count of a state for what has not happened."""

FaultIn = Callable[[Path, int, str], str | None]
"""Like `files.fault_in`, which it is unless the caller remembers what was checked before."""


class Arrays(Mapping[str, np.ndarray]):
    """State and open tails of a checkpoint by name, each read when it is first asked for.

    The file stays open, so the arrays can be read even if the run has gone on and removed it.
    """

    def __init__(self, file: Path) -> None:
        self._stored = np.load(file, allow_pickle=False)
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._read:
            self._read[name] = self._stored[name]
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._stored.files)

    def __len__(self) -> int:
        return len(self._stored.files)


def count(arrays: Mapping[str, np.ndarray], name: str) -> np.ndarray:
    """Return a state's 64-bit numbers of one name, uint64, which it holds in two words."""
    hi, lo = arrays[f"{name}.hi"].astype(np.uint64), arrays[f"{name}.lo"]
    return (hi << np.uint64(32)) | lo


def world_ticks(arrays: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return the ticks that each world of a state has lived through, uint64 (W,)."""
    return count(arrays, "world.worlds.tick")


@dataclass(frozen=True)
class Checkpoint:
    """A checkpoint whose checksums hold."""

    path: Path
    manifest: dict[str, Any]

    def arrays(self) -> Arrays:
        """Open its state and tails."""
        return Arrays(self.path / "state.npz")

    @property
    def progress(self) -> Progress:
        """As it was then."""
        return Progress(**self.manifest["progress"])

    @property
    def digests(self) -> dict[str, np.ndarray]:
        """Of each table the sums of row hashes, uint64 (W, 2)."""
        return {name: np.array(v, np.uint64) for name, v in self.manifest["digests"].items()}


def save(run: Path, arrays: dict[str, np.ndarray], recorder: Recorder, progress: Progress) -> None:
    """Write a checkpoint and drop those no longer needed.

    Raises:
        Trouble: it cannot be written; those before it stay good.
    """
    number = 1 + max((int(path.name) for path in numbered(run)), default=-1)
    final = run / "checkpoints" / f"{number:06d}"
    _write(run, final, arrays, recorder, progress)
    try:
        for old in numbered(run)[:-KEPT]:
            shutil.rmtree(old)
    except OSError as error:
        raise Trouble(f"{old} cannot be removed: {error.strerror or error}") from None


def save_origin(
    run: Path, arrays: dict[str, np.ndarray], recorder: Recorder, progress: Progress
) -> None:
    """Write what a fork begins with; see `save`."""
    _write(run, run / ORIGIN, arrays, recorder, progress)


def _write(
    run: Path,
    final: Path,
    arrays: dict[str, np.ndarray],
    recorder: Recorder,
    progress: Progress,
) -> None:
    temporary = final.with_name(files.TEMPORARY + final.name)
    try:
        temporary.mkdir(parents=True)
        _fill(run, temporary, arrays, recorder, progress)
        temporary.rename(final)
        files.sync(final.parent)
    except OSError as error:
        shutil.rmtree(temporary, ignore_errors=True)
        raise Trouble(f"{final} cannot be written: {error.strerror or error}") from None


def _fill(
    run: Path,
    folder: Path,
    arrays: dict[str, np.ndarray],
    recorder: Recorder,
    progress: Progress,
) -> None:
    state, manifest = folder / "state.npz", folder / "manifest.json"
    np.savez(state, allow_pickle=False, **arrays, **recorder.tails())
    files.sync(state)
    content = {
        "progress": vars(progress),
        "inputs": {name: files.seal(run / name) for name in INPUTS if (run / name).exists()},
        "state": files.seal(state),
        "segments": {table.name: table.segments for table in recorder.tables},
        "digests": {table.name: table.digest.tolist() for table in recorder.tables},
    }
    manifest.write_text(json.dumps({**content, "sha256": _checksum(content)}, indent=1))
    files.sync(manifest)
    files.sync(folder)


def _checksum(manifest: dict[str, Any]) -> str:
    """Of a manifest's other entries."""
    content = {name: value for name, value in manifest.items() if name != "sha256"}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def none_whole(run: Path, faults: list[str]) -> Trouble:
    """The error of a run none of whose checkpoints is whole."""
    again = f"`primordia run {run / 'config.toml'}` lives it again from its beginning"
    if (run / ORIGIN).exists():
        again = "fork it again"
    return Trouble(f"no checkpoint of {run} is whole: {faults[0]}; {again}")


def numbered(run: Path) -> list[Path]:
    """The run's checkpoints, oldest first."""
    found = (path for path in (run / "checkpoints").glob("[0-9]*") if path.name.isdigit())
    return sorted(found, key=lambda path: int(path.name))


def newest(run: Path, fault_in: FaultIn = files.fault_in) -> tuple[Checkpoint | None, list[str]]:
    """The newest checkpoint that is whole, segments included; and what is wrong with newer ones."""
    faults: list[str] = []
    for found in _newest_first(run, fault_in):
        if isinstance(found, Checkpoint):
            return found, faults
        faults.append(found)
    return None, faults


def whole(run: Path, fault_in: FaultIn = files.fault_in) -> Iterator[Checkpoint]:
    """All that are whole, newest first, a fork's origin last."""
    return (found for found in _newest_first(run, fault_in) if isinstance(found, Checkpoint))


def origin(run: Path, fault_in: FaultIn = files.fault_in) -> Checkpoint | None:
    """What a fork began with; None if the run is no fork.

    Raises:
        Trouble: it is damaged.
    """
    if not (run / ORIGIN).exists():
        return None
    found = _read(run, run / ORIGIN, fault_in)
    if isinstance(found, str):
        raise Trouble(found)
    return found


def _newest_first(run: Path, fault_in: FaultIn) -> Iterator[Checkpoint | str]:
    for path in reversed(numbered(run)):
        yield _read(run, path, fault_in)
    if (run / ORIGIN).exists():
        yield _read(run, run / ORIGIN, fault_in)


def _read(run: Path, path: Path, fault_in: FaultIn) -> Checkpoint | str:
    """It, or what is wrong with it; raises Trouble if an input of all is no longer what it was."""
    try:
        manifest = json.loads((path / "manifest.json").read_text())
        if manifest["sha256"] != _checksum(manifest):
            raise ValueError
        inputs = manifest["inputs"].items()
        sealed = [(path / "state.npz", manifest["state"])]
        for table in TABLES:
            sealed += [(run / table / each["name"], each) for each in manifest["segments"][table]]
    except (OSError, ValueError, KeyError, TypeError):
        return f"{path / 'manifest.json'} is missing or damaged"
    for name, seal in inputs:
        if fault := fault_in(run / name, seal["bytes"], seal["sha256"]):
            raise Trouble(f"{fault}; put it back (`primordia fork` goes on with other settings)")
    for file, seal in sealed:
        if fault := fault_in(file, seal["bytes"], seal["sha256"]):
            return fault
    return Checkpoint(path, manifest)


def remove_what_does_not_count(run: Path, last: Checkpoint | None) -> None:
    """Delete whatever the given checkpoint does not name: what was being written in a crash."""
    before = numbered(run)
    kept = before[: before.index(last.path) + 1] if last and last.path in before else []
    for path in (run / "checkpoints").iterdir():
        if path not in kept:
            _remove(path)
    for table in TABLES:
        named = {each["name"] for each in last.manifest["segments"][table]} if last else set()
        for path in (run / table).iterdir():
            if path.name not in named:
                _remove(path)


def _remove(path: Path) -> None:
    try:
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    except OSError as error:
        raise Trouble(f"{path} cannot be removed: {error.strerror}") from None
