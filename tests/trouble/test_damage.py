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


def miscount(path: Path) -> None:
    """Change a number and leave valid JSON."""
    content = json.loads(path.read_text())
    content["progress"]["wall_s"] += 1
    path.write_text(json.dumps(content))


@pytest.mark.parametrize(
    ("name", "damage"),
    [
        ("state.npz", flip),
        ("manifest.json", miscount),
    ],
)
def test_a_damaged_checkpoint_is_skipped(
    run: Path, through: str, name: str, damage: Callable[[Path], None]
) -> None:
    file = newest(run) / name
    damage(file)
    shown = here("info", run)
    assert (shown.returncode, shown.stderr) == (0, "")
    assert f"not the newest state, since a checkpoint is damaged: {file}" in shown.stdout
    complains(here("verify", run), 1, str(file))
    done = here("resume", run, "--ticks", TICKS, "--quiet")
    complains(done, 0, "a damaged checkpoint was not used", str(file))
    assert digest(run) == through
    assert "damaged" not in here("info", run).stdout


@pytest.mark.parametrize(
    ("where", "damage"),
    [
        ("births/000000.parquet", Path.unlink),
        ("deaths/000000.parquet", flip),
        ("config.toml", Path.unlink),
    ],
)
def test_damage_to_a_file_that_all_checkpoints_need_is_an_error(
    run: Path, where: str, damage: Callable[[Path], None]
) -> None:
    """The damaged part of a table is not the newest one."""
    assert here("resume", run, "--ticks", TICKS, "--quiet").returncode == 0
    assert (run / "deaths" / "000001.parquet").exists()
    damage(run / where)
    before = contents(run)
    for command in ("info", "resume", "verify"):
        done = here(command, run)
        assert done.returncode in (1, 2)
        complains(done, done.returncode, str(run / where))
    assert contents(run) == before


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
