"""The folder of a run: which runs may begin in it, its settings, and its notes on failures."""

import fcntl
import json
from pathlib import Path
from typing import Any

import pytest

from primordia.errors import InputError, Trouble
from primordia.runs import directory, loop
from tests.worlds import MEADOW, config


def test_a_run_begins_in_a_folder_with_at_most_a_lock(tmp_path: Path) -> None:
    directory.refuse_if_taken(tmp_path / "new")
    directory.refuse_if_taken(tmp_path)
    (tmp_path / "lock").touch()
    directory.refuse_if_taken(tmp_path)
    (tmp_path / "mine").touch()
    with pytest.raises(InputError, match=f"^{tmp_path} exists already and is not a run; "):
        directory.refuse_if_taken(tmp_path)
    with pytest.raises(InputError, match="exists already and is not a run"):
        directory.refuse_if_taken(tmp_path / "mine")
    (tmp_path / "versions.json").touch()
    with pytest.raises(InputError, match=f"continue the run with `primordia resume {tmp_path}`$"):
        directory.refuse_if_taken(tmp_path)


def test_a_lock_is_seen_while_it_is_held(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A writer that comes at the moment of a look waits for its end."""
    assert not directory.is_written(tmp_path)
    with directory.locked(tmp_path):
        assert directory.is_written(tmp_path)
    assert not directory.is_written(tmp_path)
    with (tmp_path / "lock").open("rb") as other_reader:
        fcntl.flock(other_reader, fcntl.LOCK_SH)
        assert not directory.is_written(tmp_path), "another reader is no writer"
        monkeypatch.setattr("time.sleep", lambda _: fcntl.flock(other_reader, fcntl.LOCK_UN))
        with directory.locked(tmp_path):
            assert directory.is_written(tmp_path)


STARTED = (
    "versions.json", ".writing-config.toml", "births/a", "deaths/a", "metrics/a", "checkpoints/000000",
    "code/a.py", "origin/a", "config.toml", "description.json", "founders.safetensors",
    ".writing-checkpoints",
)  # fmt: skip


def test_files_of_a_start_that_was_killed_are_removed_and_others_stay(tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert directory.clear_unbegun(run), "there is no folder"
    for name in (*STARTED[1:], "mine.txt", ".writing-mine", "lock"):
        (run / name).parent.mkdir(parents=True, exist_ok=True)
        (run / name).touch()
    before = sorted(run.rglob("*"))
    assert directory.clear_unbegun(run), "no start is marked, so nothing is removed"
    assert sorted(run.rglob("*")) == before
    (run / directory.UNBEGUN).touch()
    with directory.locked(run), pytest.raises(InputError, match="is being written by another"):
        directory.clear_unbegun(run)
    assert directory.clear_unbegun(run)
    assert sorted(path.name for path in run.iterdir()) == [".writing-mine", "lock", "mine.txt"]
    for name in ("versions.json", directory.UNBEGUN, "config.toml"):
        (run / name).touch()
    assert not directory.clear_unbegun(run), "a folder with versions is a run"
    assert (run / "config.toml").exists()


@pytest.mark.parametrize(
    ("versions", "origin", "replaced"),
    [(True, True, False), (True, False, False), (False, True, False), (False, False, True)],
)
def test_only_a_run_that_can_go_on_stays_after_an_error_at_its_start(
    versions: bool, origin: bool, replaced: bool, tmp_path: Path
) -> None:
    """Such a run has versions and a checkpoint. A folder of another process stays unchanged."""
    run = tmp_path / "run"

    def fail() -> None:
        if replaced:
            run.rename(tmp_path / "moved")
            run.mkdir()
            (run / "config.toml").touch()
        if origin:
            (run / "origin").mkdir()
        raise Trouble("full")

    with (
        pytest.raises(Trouble, match="full"),
        directory.create(run, config(MEADOW), None if versions else fail),
    ):
        fail()
    stays = (versions and origin) or replaced
    assert (run / "config.toml").exists() == run.exists() == stays


@pytest.mark.parametrize("format", [1, 2, 3])
def test_runs_of_another_format_are_refused(format: int, tmp_path: Path) -> None:
    (tmp_path / "versions.json").write_text(json.dumps({"format": format}))
    says = {
        1: f"{tmp_path} has format 1, and this primordia reads format 2 only; `primordia run"
        f" {tmp_path / 'config.toml'}` repeats the run from its beginning",
        2: f"{tmp_path / 'config.toml'} is missing; put it back",
        3: f"{tmp_path} was made by a newer primordia (format 3, this one reads 2); upgrade",
    }
    with pytest.raises(InputError) as raised:
        directory.read_config(tmp_path)
    assert str(raised.value) == says[format]


BLOCK = {"mutation": {"blocks": {"recurrent": {"scale": 0.5}}}}


@pytest.mark.parametrize(
    ("before", "now", "differs"),
    [
        ({}, {"about": "another", "stop": {"ticks": 3}}, None),
        ({}, {"seed": 1}, "seed is 0 there, and 1 here"),
        (BLOCK, {}, "mutation.blocks.recurrent.scale is 0.5 there, and None here"),
        ({}, BLOCK, "mutation.blocks.recurrent.scale is None there, and 0.5 here"),
    ],
)
def test_a_run_goes_on_only_with_the_settings_of_its_beginning(
    before: dict[str, Any],
    now: dict[str, Any],
    differs: str | None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Limits, description and the paths of ancestors may differ."""
    there = config(MEADOW, **before).model_copy(update={"ancestors": ["a"]})
    monkeypatch.setattr(directory, "read_config", lambda _: there)
    if differs is None:
        directory.check_same_settings(config(MEADOW, **now), tmp_path)
        return
    says = f"was begun with other settings: {differs}; choose another --out"
    with pytest.raises(InputError, match=says):
        directory.check_same_settings(config(MEADOW, **now), tmp_path)


@pytest.mark.parametrize("seconds", [-0.1, float("nan")])
def test_seconds_between_checkpoints_are_0_or_more(seconds: float, tmp_path: Path) -> None:
    for begin in (
        lambda: loop.start(config(MEADOW), tmp_path / "run", checkpoint_every=seconds),
        lambda: loop.resume(tmp_path / "run", checkpoint_every=seconds),
    ):
        with pytest.raises(InputError, match=f"0 or more, not {seconds}$"):
            begin()
    assert not (tmp_path / "run").exists()


def test_each_failure_is_a_line_at_the_end_of_a_file(tmp_path: Path) -> None:
    directory.note_faults(tmp_path, [])
    assert not (tmp_path / "faults.txt").exists()
    directory.note_faults(tmp_path, ["first", "second\x1b\nand more"])
    directory.note_faults(tmp_path, ["third"])
    lines = (tmp_path / "faults.txt").read_text().splitlines()
    assert (len(lines), lines[0], lines[2]) == (3, "first", "third")
    assert "\x1b" not in lines[1]
    (tmp_path / "target").touch()
    (tmp_path / "link").mkdir()
    (tmp_path / "link" / "faults.txt").symlink_to(tmp_path / "target")
    with pytest.raises(InputError, match=f"{tmp_path / 'link' / 'faults.txt'} is a symbolic link"):
        directory.note_faults(tmp_path / "link", ["first"])
    assert (tmp_path / "target").read_text() == ""
