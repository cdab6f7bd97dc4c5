"""Checkpoints: all that is needed to go on, written so that a crash at any instant leaves a good one.

RUN/checkpoints/000012/state.npz        the state's arrays, and `tail.*`: rows in no segment yet
                       manifest.json    written last: checksums, the segments that count, progress
"""

import hashlib
import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from primordia import files
from primordia.errors import Trouble
from primordia.record import TABLES, Recorder

KEPT = 2
"""Checkpoints kept; should the newest be damaged, the one before serves."""


@dataclass
class Progress:
    """What a manifest says of the run as a whole."""

    limits: dict[str, Any]
    """ticks, births, until: as last asked for"""
    wall_s: float
    """seconds spent so far"""
    exact: bool
    """whether all of it can be repeated bit for bit"""


@dataclass(frozen=True)
class Checkpoint:
    """A checkpoint whose checksums hold."""

    path: Path
    manifest: dict[str, Any]

    def arrays(self) -> dict[str, np.ndarray]:
        """State and tails, by name."""
        with np.load(self.path / "state.npz", allow_pickle=False) as stored:
            return dict(stored)

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
    folder = run / "checkpoints"
    number = 1 + max((int(path.name) for path in numbered(run)), default=-1)
    temporary, final = folder / f"{files.TEMPORARY}{number:06d}", folder / f"{number:06d}"
    try:
        temporary.mkdir(parents=True)
        _fill(temporary, arrays, recorder, progress)
        temporary.rename(final)
        files.sync(folder)
        for old in numbered(run)[:-KEPT]:
            shutil.rmtree(old)
    except OSError as error:
        shutil.rmtree(temporary, ignore_errors=True)
        raise Trouble(f"{final} cannot be written: {error.strerror or error}") from None


def _fill(
    folder: Path, arrays: dict[str, np.ndarray], recorder: Recorder, progress: Progress
) -> None:
    state, manifest = folder / "state.npz", folder / "manifest.json"
    np.savez(state, allow_pickle=False, **arrays, **recorder.tails())
    files.sync(state)
    content = {
        "progress": vars(progress),
        "config": files.seal(folder.parent.parent / "config.toml"),
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
    return Trouble(
        f"no checkpoint of {run} is whole: {faults[0]}; `primordia run {run / 'config.toml'}` lives"
        " it again from its beginning"
    )


def numbered(run: Path) -> list[Path]:
    """The run's checkpoints, oldest first."""
    found = (path for path in (run / "checkpoints").glob("[0-9]*") if path.name.isdigit())
    return sorted(found, key=lambda path: int(path.name))


def newest(run: Path) -> tuple[Checkpoint | None, list[str]]:
    """The newest checkpoint that is whole, segments included; and what is wrong with newer ones."""
    faults: list[str] = []
    for path in reversed(numbered(run)):
        found = _read(run, path)
        if isinstance(found, Checkpoint):
            return found, faults
        faults.append(found)
    return None, faults


def _read(run: Path, path: Path) -> Checkpoint | str:
    try:
        manifest = json.loads((path / "manifest.json").read_text())
        if manifest["sha256"] != _checksum(manifest):
            raise ValueError
        sealed = [
            (run / "config.toml", manifest["config"]),
            (path / "state.npz", manifest["state"]),
        ]
        for table in TABLES:
            sealed += [(run / table / each["name"], each) for each in manifest["segments"][table]]
    except (OSError, ValueError, KeyError, TypeError):
        return f"{path / 'manifest.json'} is missing or damaged"
    for file, seal in sealed:
        if fault := files.fault_in(file, seal):
            return fault
    return Checkpoint(path, manifest)


def remove_what_does_not_count(run: Path, last: Checkpoint | None) -> None:
    """Delete whatever the given checkpoint does not name: what was being written in a crash."""
    kept = [path for path in numbered(run) if last and int(path.name) <= int(last.path.name)]
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
