"""Checkpoints: their numbers, the newest one, leftovers, and the files that a manifest names."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia import files
from primordia.errors import Trouble
from primordia.runs import checkpoint, manifest
from primordia.runs.manifest import Manifest, Progress, Seal, Segment
from primordia.runs.recorder import Recorder
from primordia.runs.schema import TABLES, Schema
from primordia.settings.limits import Stop

SCHEMA = Schema(4, mates=False, notes=(), rates=(), tallies=())
PROGRESS = Progress(limits=Stop(ticks=9), wall_s=1.5, exact=True)


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """The folders of a run, with its settings and a file of the user's own code."""
    for name in (*TABLES, checkpoint.FOLDER, "code/mine"):
        (tmp_path / name).mkdir(parents=True)
    names = "config.toml", "description.json", "founders.safetensors", "code/mine/pond.py"
    for name in (*names, "code/mine/notes.txt"):
        (tmp_path / name).write_text(name)
    return tmp_path


def save(run: Path, number: int) -> None:
    checkpoint.save(run, {"number": np.array([number])}, Recorder(run, 1, SCHEMA), PROGRESS)


def names(run: Path) -> list[str]:
    return [path.name for path in checkpoint.numbered(run)]


def number_in(stored: checkpoint.Checkpoint | None) -> int:
    assert stored is not None
    return int(stored.arrays(lambda *_: None)["number"][0])


def test_the_newest_two_are_kept_and_numbers_begin_at_0(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A run may hold more than two checkpoints, such as a run that another program copied."""
    assert not checkpoint.exists(run)
    monkeypatch.setattr(checkpoint, "KEPT", 4)
    for number in range(4):
        save(run, number)
    assert names(run) == ["000000", "000001", "000002", "000003"]
    monkeypatch.setattr(checkpoint, "KEPT", 2)
    save(run, 4)
    assert names(run) == ["000003", "000004"]
    assert checkpoint.exists(run)
    assert [number_in(each) for each in checkpoint.whole_checkpoints(run)] == [4, 3]


def test_numbers_of_more_than_six_digits_are_in_order_of_size(run: Path) -> None:
    save(run, 0)
    (run / "checkpoints" / "000000").rename(run / "checkpoints" / "999999")
    for name in ("12345", "1234567890", "00000x", ".writing-000001"):
        (run / "checkpoints" / name).mkdir()
    for number in (1, 2):
        save(run, number)
    assert names(run) == ["1000000", "1000001"]
    assert number_in(checkpoint.newest(run)[0]) == 2


def test_a_manifest_names_the_settings_and_the_code(run: Path) -> None:
    save(run, 0)
    stored, faults = checkpoint.newest(run)
    assert faults == []
    names = ["config.toml", "description.json", "founders.safetensors", "code/mine/pond.py"]
    assert list(stored.manifest.inputs) == names
    assert stored.manifest.progress == PROGRESS
    assert stored.manifest.segments == {name: [] for name in TABLES}
    assert {name: sums.shape for name, sums in stored.digests.items()} == dict.fromkeys(
        TABLES, (1, 2)
    )


@pytest.mark.parametrize("first", ["checkpoints/000000", "origin"])
def test_a_file_that_is_edited_while_the_run_lives_is_not_approved(run: Path, first: str) -> None:
    checkpoint.write(run, run / first, {}, Recorder(run, 1, SCHEMA), PROGRESS)
    (run / "config.toml").write_text("other")
    save(run, 1)
    with pytest.raises(Trouble, match=r"config\.toml .*; put the file back"):
        checkpoint.newest(run)


def test_faults_of_checkpoints_are_in_order_newest_first(run: Path) -> None:
    """A fork without a whole checkpoint begins with its origin; another run must be repeated."""
    for number in range(2):
        save(run, number)
    states = [run / "checkpoints" / f"{number:06d}" / "state.npz" for number in (1, 0)]
    states[0].unlink()
    last, faults = checkpoint.newest(run)
    assert (number_in(last), faults) == (0, [f"{states[0]} is missing"])
    states[1].unlink()
    last, faults = checkpoint.newest(run)
    assert (last, faults) == (None, [f"{each} is missing" for each in states])
    whole = f"no checkpoint of {run} is whole: {states[0]} is missing; "
    again = f"`primordia run {run / 'config.toml'}` repeats the run from its beginning"
    assert str(checkpoint.no_whole_checkpoint(run, faults)) == whole + again
    assert checkpoint.origin(run) is None
    arrays = {"number": np.array([7])}
    checkpoint.write(run, run / "origin", arrays, Recorder(run, 1, SCHEMA), PROGRESS)
    assert number_in(checkpoint.origin(run)) == number_in(checkpoint.newest(run)[0]) == 7
    assert str(checkpoint.no_whole_checkpoint(run, faults)) == whole + "fork it again"
    (run / "origin" / "state.npz").write_bytes(b"")
    with pytest.raises(Trouble, match=r"state\.npz has 0 bytes instead of"):
        checkpoint.origin(run)


@pytest.mark.parametrize("kept", [2, 1, 0])
def test_files_later_than_a_checkpoint_are_removed(run: Path, kept: int) -> None:
    """Earlier checkpoints stay, and so do the segments that the checkpoint names."""
    recorder = Recorder(run, 1, SCHEMA)
    checkpoint.write(run, run / "origin", {"a": np.zeros(1)}, recorder, PROGRESS)
    segments = [f"{number:06d}.parquet" for number in range(3)]
    for name in segments:
        (run / "deaths" / name).write_bytes(b"")
        sealed = Segment(name=name, rows=0, **files.seal(run / "deaths" / name))
        recorder.tables[1].segments.append(sealed)
        if len(recorder.tables[1].segments) < 3:
            checkpoint.save(run, {"a": np.zeros(1)}, recorder, PROGRESS)
    (run / "births" / ".writing-000000.parquet").write_bytes(b"")
    (run / "checkpoints" / ".writing-000002").mkdir()
    newest_first = [*checkpoint.whole_checkpoints(run)]
    checkpoint.remove_leftovers(run, newest_first[2 - kept])
    assert [path.name for path in sorted((run / "checkpoints").iterdir())] == [
        f"{number:06d}" for number in range(kept)
    ]
    assert sorted(path.name for path in (run / "deaths").iterdir()) == segments[:kept]
    assert not any((run / "births").iterdir())
    assert (run / "origin").is_dir()


NAMES = {
    "config.toml": True,
    "versions.json": False,
    "code": False,
    "code/a.py": True,
    "code/../a.py": False,
    "other/a.py": False,
    "code/" + "d/" * 15 + "a.py": True,
    "code/" + "d/" * 16 + "a.py": False,
}


@pytest.mark.parametrize("name", NAMES)
def test_a_manifest_names_only_files_of_a_run(name: str) -> None:
    content: dict[str, Any] = {
        "progress": PROGRESS, "inputs": {name: Seal(0, "0" * 64)}, "state": Seal(0, "0" * 64),
        "segments": {table: [] for table in TABLES}, "digests": {table: [] for table in TABLES},
    }  # fmt: skip
    if not NAMES[name]:
        with pytest.raises(ValueError, match="is not a file of a run"):
            Manifest(**content)
        return
    sealed = Manifest(**content)
    assert manifest.parsed(sealed.text().encode()) == sealed
