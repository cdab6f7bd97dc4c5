"""Damage to the files of a run."""

import json
import shutil
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from primordia.runs import checkpoint
from tests.commands import complains, here
from tests.trouble import TICKS, contents, digest, flip, goes_on, newest, started


def empty(path: Path) -> None:
    path.write_bytes(b"")


def truncate(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-100])


def garble(path: Path) -> None:
    path.write_bytes(b"\xff\xfe garbage \x00")


def miscount(path: Path) -> None:
    """Change a number and leave valid JSON."""
    content = json.loads(path.read_text())
    content["progress"]["wall_s"] += 1
    path.write_text(json.dumps(content))


@pytest.mark.parametrize("damage", [flip, truncate, Path.unlink])
def test_a_checkpoint_with_a_damaged_state_is_skipped(
    run: Path, through: str, damage: Callable[[Path], None]
) -> None:
    state = newest(run) / "state.npz"
    damage(state)
    shown = here("info", run)
    assert (shown.returncode, shown.stderr) == (0, "")
    assert f"not the newest state, since a checkpoint is damaged: {state}" in shown.stdout
    complains(here("verify", run), 1, str(state))
    done = here("resume", run, "--ticks", TICKS, "--quiet")
    complains(done, 0, "a damaged checkpoint was not used", str(state))
    assert digest(run) == through
    assert "damaged" not in here("info", run).stdout


@pytest.mark.parametrize("damage", [miscount, garble, empty])
def test_a_checkpoint_with_a_damaged_manifest_is_skipped(
    run: Path, through: str, damage: Callable[[Path], None]
) -> None:
    manifest = newest(run) / "manifest.json"
    damage(manifest)
    done = here("resume", run, "--ticks", TICKS, "--quiet")
    complains(done, 0, "was not used", str(manifest), "missing or damaged")
    assert digest(run) == through


@pytest.mark.parametrize("where", ["births/000000.parquet", "deaths/000000.parquet", "config.toml"])
@pytest.mark.parametrize("damage", [flip, Path.unlink])
def test_damage_to_a_file_that_all_checkpoints_need_is_an_error(
    run: Path, where: str, damage: Callable[[Path], None]
) -> None:
    damage(run / where)
    before = contents(run)
    for command in ("info", "resume", "verify"):
        done = here(command, run)
        assert done.returncode in (1, 2)
        complains(done, done.returncode, str(run / where))
    assert contents(run) == before


@pytest.mark.parametrize("damage", [flip, Path.unlink])
def test_damage_to_an_earlier_part_of_a_table_is_noticed(
    run: Path, damage: Callable[[Path], None]
) -> None:
    assert here("resume", run, "--ticks", TICKS, "--quiet").returncode == 0
    early, late = (run / "deaths" / f"{number:06}.parquet" for number in range(2))
    assert late.exists()
    damage(early)
    for command in (("info", run), ("resume", run, "--ticks", TICKS + 100, "--quiet")):
        complains(here(*command), 1, str(early))


def test_damage_to_the_only_checkpoint_is_noticed(run: Path, through: str, tmp_path: Path) -> None:
    shutil.rmtree(checkpoint.numbered(run)[0])
    flip(newest(run) / "state.npz")
    before = contents(run)
    again = f"primordia run {run / 'config.toml'}"
    for command in ("info", "resume"):
        complains(here(command, run), 1, f"no checkpoint of {run} is whole", "state.npz", again)
    assert contents(run) == before
    words = (run / "config.toml", "--ticks", TICKS, "--out", tmp_path / "again", "--quiet")
    assert here("run", *words).returncode == 0
    assert digest(tmp_path / "again") == through


def test_a_run_with_a_changed_configuration_is_refused(run: Path) -> None:
    config = run / "config.toml"
    config.write_text(config.read_text().replace("seed = 0", "seed = 1"))
    for command in ("info", "resume", "verify"):
        complains(
            here(command, run), 1, str(config), "changed", "put the file back", "primordia fork"
        )


def test_folders_lost_in_a_copy_are_made_again(run: Path, through: str, tmp_path: Path) -> None:
    fresh = tmp_path / "fresh"
    with pytest.raises(KeyboardInterrupt):
        started(fresh, lambda _: signal.raise_signal(signal.SIGINT))
    for folder in ("births", "deaths", "metrics"):
        (fresh / folder).rmdir()
    (fresh / "checkpoints" / "note.txt").write_text("not a checkpoint")
    goes_on(fresh, through)
