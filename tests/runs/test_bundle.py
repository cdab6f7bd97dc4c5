"""A run in one file: equal bytes, and the same run."""

import os
import shutil
import zipfile
from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.errors import Trouble
from primordia.runs import bundle, directory, loop
from tests.bundles import SETTINGS, temporary_files  # noqa: F401, which pytest calls
from tests.commands import complains, here
from tests.trouble import newest
from tests.worlds import config, digests_of


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run that was stopped once, so that it has two checkpoints."""
    run = tmp_path_factory.mktemp("made") / "run"
    loop.start(config(SETTINGS), run)
    loop.resume(run, {"ticks": 90})
    return run


@pytest.fixture(scope="module")
def fork(run: Path) -> Path:
    return primordia.load(run).fork(50, run.parent / "fork", seed=4, stop={"ticks": 80}).path


@pytest.fixture(scope="module")
def file(run: Path) -> Path:
    return primordia.load(run).bundle(run.parent / "sent" / "run.zip")


@pytest.mark.parametrize("which", ["run", "fork"])
def test_a_bundle_is_the_run_again(
    which: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """Its bytes are equal when it is made again, also of itself; numbers, figures and lives are equal."""
    path: Path = request.getfixturevalue(which)
    first, second, third = (tmp_path / f"{name}.zip" for name in "abc")
    done = here("bundle", path, first)
    assert done.stdout == f"{first}: {first.stat().st_size:,} bytes\n"
    copy = Path(shutil.copytree(path, tmp_path / "copy"))
    for each in copy.rglob("*"):
        os.utime(each, (0, 0))
    primordia.load(copy).bundle(second)
    primordia.load(first).bundle(third)
    assert first.read_bytes() == second.read_bytes() == third.read_bytes()
    assert primordia.load(first).info() == primordia.load(path).info()
    if which == "fork":  # its figures need what lived before the fork, too
        for place, out in ((first, "there"), (path, "here")):
            assert here("plot", place, "--figure", "ages", "--out", tmp_path / out).returncode == 0
        drawn, expected = (tmp_path / each / "ages.png" for each in ("there", "here"))
        assert drawn.read_bytes() == expected.read_bytes()
    for number in primordia.load(path).lives().of_world(0).id[::60].tolist():
        relived = [primordia.load(each).organism(number).relive() for each in (first, path)]
        assert relived[0].agrees
        assert relived[0].respects == relived[1].respects


def test_a_bundle_holds_what_the_newest_checkpoint_names_alone(
    run: Path, file: Path, tmp_path: Path
) -> None:
    (run / "figures").mkdir()
    (run / "figures" / "mine.png").write_bytes(b"x")
    (run / "births" / "000009.parquet").write_bytes(b"left over")
    assert primordia.load(run).bundle(tmp_path / "a.zip").read_bytes() == file.read_bytes()
    shutil.rmtree(run / "figures")
    (run / "births" / "000009.parquet").unlink()
    with zipfile.ZipFile(file) as zipped:
        names = {each.filename.removeprefix("run/") for each in zipped.infolist()}
        assert {each.date_time for each in zipped.infolist()} == {bundle.EPOCH}
        assert {each.external_attr >> 16 for each in zipped.infolist()} == {0o100644}
        assert [each.filename for each in zipped.infolist()] == sorted(zipped.namelist())
    held = {"state.npz", "manifest.json"}
    expected = {f"checkpoints/{newest(run).name}/{name}" for name in held}
    expected |= {"versions.json", "config.toml", "description.json"}
    expected |= {"code/tests/toys.py", "code/tests/__init__.py"}  # of the habitat
    expected |= {f"{path.parent.name}/{path.name}" for path in run.glob("*/*.parquet")}
    assert names == expected


def test_a_run_that_goes_on_is_bundled_as_of_its_newest_checkpoint(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Path(shutil.copytree(run, tmp_path / "run"))
    named, seen = bundle._named, []

    def overtaken(archive: Any) -> Any:
        names = named(archive)
        seen.append(archive.last.path.name)
        if len(seen) == 1:  # meanwhile the writer has made two checkpoints
            for number in (7, 8):
                shutil.copytree(newest(run), run / "checkpoints" / f"{number:06d}")
            shutil.rmtree(archive.last.path)
        return names

    monkeypatch.setattr(bundle, "_named", overtaken)
    with directory.locked(run):
        primordia.load(run).bundle(tmp_path / "a.zip")
    assert seen[-1] == "000008"
    assert primordia.load(tmp_path / "a.zip").info() == primordia.load(run).info()
    monkeypatch.setattr(bundle, "_named", lambda _: {"checkpoints/000001/gone": None})
    with pytest.raises(Trouble, match="changes faster than it can be read"):
        bundle.write(run, tmp_path / "b.zip")
    assert not (tmp_path / "b.zip").exists()


def test_a_run_made_of_a_bundle_goes_on_as_the_run_itself(
    run: Path, file: Path, tmp_path: Path
) -> None:
    done = here("unbundle", file, tmp_path / "there" / "run")
    assert done.stdout == f"{tmp_path / 'there' / 'run'}\n"
    through = Path(shutil.copytree(run, tmp_path / "through"))
    for each in (tmp_path / "there" / "run", through):
        assert here("resume", each, "--ticks", 120, "--quiet").returncode == 0
    assert digests_of(through) == digests_of(tmp_path / "there" / "run")
    complains(here("unbundle", file, through), 2, "exists already; name another folder")
    complains(here("unbundle", file, file), 2, "exists already")
    complains(here("unbundle", through, tmp_path / "new"), 2, "there is no bundle")
    (tmp_path / "empty").mkdir()
    assert here("unbundle", file, tmp_path / "empty").returncode == 0
    assert sorted(os.listdir(tmp_path)) == ["empty", "there", "through"]


def test_nothing_is_written_into_a_bundle(file: Path, tmp_path: Path) -> None:
    before = file.read_bytes()
    for words in (["resume", "--ticks", "200"], ["plot"], ["replay"], ["film"], ["report"]):
        done = here(words[0], file, *words[1:])
        complains(done, 2, f"is a bundle and cannot be changed; `primordia unbundle {file} FOLDER`")
    done = here("fork", file, "--at", 40, "--ticks", 45, "--out", tmp_path / "fork", "--quiet")
    assert done.returncode == 0, done.stderr
    assert f'run = "{file}"' in (tmp_path / "fork" / "config.toml").read_text(encoding="utf-8")
    assert file.read_bytes() == before
    assert os.listdir(file.parent) == [file.name]


def test_bundles_are_runs_of_an_arm(run: Path, file: Path, tmp_path: Path) -> None:
    loop.start(config({**SETTINGS, "seed": 3}), tmp_path / "other")
    primordia.load(tmp_path / "other").bundle(tmp_path / "other.zip")
    sent = primordia.load([file, tmp_path / "other.zip"]).info()
    assert sent["worlds"] == primordia.load([run, tmp_path / "other"]).info()["worlds"]
    complains(here("plot", file, tmp_path / "other.zip"), 2, "is a bundle and cannot be changed")


@pytest.mark.parametrize("change", ["nothing", "size", "time", "file"])
def test_a_bundle_is_unpacked_again_only_if_it_is_another_file(
    change: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file is another one if its length, its time or its inode differs."""
    unpacked: list[bytes] = []
    monkeypatch.setattr(bundle, "_extract", lambda file, _: unpacked.append(file.read_bytes()))
    (file := tmp_path / "a.zip").write_bytes(b"first")
    first, at = bundle.opened(file), file.stat()
    if change == "file":
        (tmp_path / "b").write_bytes(b"other")
        (tmp_path / "b").replace(file)
    elif change != "nothing":
        file.write_bytes(b"longer" if change == "size" else b"other")
    os.utime(file, ns=(at.st_atime_ns, at.st_mtime_ns + (change == "time")))
    assert (bundle.opened(file) == first) == (change == "nothing")
    assert len(unpacked) == 1 + (change != "nothing")


def test_one_process_unpacks_a_bundle_into_a_folder(file: Path, tmp_path: Path) -> None:
    unfinished = tmp_path / ".writing-run"
    unfinished.mkdir()
    (unfinished / "births").mkdir()  # of a process that was killed
    (unfinished / "births" / "left").touch()
    with directory.locked(unfinished):
        done = here("unbundle", file, tmp_path / "run")
        complains(done, 2, "is being written by another process")
    assert (unfinished / "births").exists()
    assert here("unbundle", file, tmp_path / "run").returncode == 0
    assert not unfinished.exists()
    assert not (tmp_path / "run" / "births" / "left").exists()
    assert here("info", tmp_path / "run").returncode == 0


def test_a_bundle_that_is_refused_leaves_no_folder(file: Path, tmp_path: Path) -> None:
    (other := tmp_path / "other.zip").write_bytes(b"no bundle")
    complains(here("unbundle", other, tmp_path / "a" / "b" / "run"), 2, "nor a bundle")
    (tmp_path / "empty").mkdir()
    (tmp_path / "link").symlink_to("empty")
    complains(here("unbundle", file, tmp_path / "link"), 2, "exists already")
    assert sorted(os.listdir(tmp_path)) == ["empty", "link", "other.zip"]
