"""Files outside of a run, or named by mistake: only regular files and new names are written."""

import os
import shutil
import signal
import socket
from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest

from primordia import files, interrupts
from primordia.errors import InputError, Trouble
from primordia.runs import directory, loop
from primordia.runs.directory import LOCK
from tests.commands import complains, here
from tests.trouble import contents, goes_on, started

PLOT = ("plot", "--figure", "ages")
FOLDERS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("births", "deaths", "metrics", "checkpoints", LOCK), ("resume",)),
    "figures": PLOT,
    "videos": ("replay",),
}
"""Things of a run that a command writes into."""
LEFTOVERS: dict[str, tuple[str, ...]] = {
    "births/.writing-000001.parquet": ("resume",),
    "deaths/000007.parquet": ("resume",),
    "checkpoints/.writing-000002": ("resume",),
    "checkpoints/000009": ("resume",),
    "figures/.writing-ages.png": PLOT,
}
"""Files that a command removes or replaces."""
TRIED = {
    ("births/.writing-000001.parquet", "new.txt"),
    ("checkpoints/.writing-000002", ""),
    ("figures/.writing-ages.png", "mine.txt"),
}


@pytest.fixture
def outside(tmp_path: Path) -> Path:
    """Make a folder with files that no command may touch."""
    folder = tmp_path / "outside"
    (folder / "inner").mkdir(parents=True)
    for name in ("mine.txt", "000000.parquet", "inner/mine.txt"):
        (folder / name).write_text("mine")
    return folder


def replace(path: Path, target: Path) -> None:
    """Put a link in place of a file or folder."""
    path.parent.mkdir(exist_ok=True)
    if path.exists():
        files.remove(path)
    path.symlink_to(target)


@pytest.mark.parametrize("name", FOLDERS)
def test_a_link_in_place_of_a_folder_of_a_run_is_refused(
    run: Path, outside: Path, name: str
) -> None:
    target = outside / "mine.txt" if name == LOCK else outside
    if (run / name).is_dir():
        shutil.copytree(run / name, outside, dirs_exist_ok=True)
    before = contents(outside)
    replace(run / name, target)
    command, *words = FOLDERS[name]
    complains(here(command, run, *words), 2, str(run / name), "is a symbolic link, not a")
    assert contents(outside) == before


@pytest.mark.parametrize(
    ("name", "target"),
    [
        pytest.param(*each, marks=() if each in TRIED else pytest.mark.slow)
        for each in product(LEFTOVERS, ("", "mine.txt", "new.txt"))
    ],
)
def test_a_link_among_the_files_of_a_run_is_not_followed(
    run: Path, through: str, outside: Path, name: str, target: str
) -> None:
    """A link leads to a folder, to a file, or to a file that would be made."""
    replace(run / name, outside / target)
    command, *words = LEFTOVERS[name]
    before = contents(outside)
    done = here(command, run, *words)
    assert done.returncode == 0, done.stderr
    assert contents(outside) == before
    assert not (run / name).is_symlink()
    goes_on(run, through)


def as_link(path: Path) -> None:
    path.with_name("target").write_text("mine")
    path.symlink_to("target")


def as_dangling_link(path: Path) -> None:
    path.symlink_to("nowhere")


def as_socket(path: Path) -> None:
    folder = os.open(path.parent, os.O_RDONLY)
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(f"/proc/self/fd/{folder}/{path.name}")  # a socket's path has at most 107 bytes
    os.close(folder)


KINDS: dict[str, Callable[[Path], None]] = {
    "a symbolic link": as_link,
    "a symbolic link, not": as_dangling_link,
    "a folder": Path.mkdir,
    "a pipe": os.mkfifo,
    "a socket": as_socket,
}


def refuses_to_write(path: Path) -> str:
    with pytest.raises(InputError) as refused:
        files.write(path, lambda temporary: temporary.write_text("new"))
    return str(refused.value)


@pytest.mark.parametrize("kind", KINDS)
def test_only_regular_files_are_replaced(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "out"
    KINDS[kind](path)
    before = path.lstat(), sorted(tmp_path.iterdir())
    assert f"{path} is {kind}" in refuses_to_write(path)
    assert (path.lstat(), sorted(tmp_path.iterdir())) == before


@pytest.mark.parametrize("path", ["/", ".", "", "a/.."])
def test_a_folder_is_no_output(path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a").mkdir()
    assert "is a folder, not a file" in refuses_to_write(Path(path))
    assert "is a device, not a file" in refuses_to_write(Path(os.devnull))


def test_a_file_that_fails_half_written_leaves_the_old_one(tmp_path: Path) -> None:
    path = tmp_path / "out"
    path.write_text("old")

    def fail(temporary: Path) -> None:
        temporary.write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        files.write(path, fail)
    assert contents(tmp_path) == {str(path): b"old"}


OUTPUTS = {
    "genome.safetensors": ("export", "RUN", "OUT/genome.safetensors"),
    "phylogeny.csv": ("phylogeny", "RUN", "--out", "OUT/phylogeny.csv"),
    "life.mp4": ("replay", "RUN", "--out", "OUT/life.mp4"),
    "ages.png": ("plot", "RUN", "--figure", "ages", "--out", "OUT"),
    "page.html": ("report", "RUN", "--out", "OUT/page.html"),
}


@pytest.mark.parametrize("name", OUTPUTS)
def test_no_command_replaces_a_pipe(half: Path, tmp_path: Path, name: str) -> None:
    os.mkfifo(tmp_path / name)
    done = here(*(w.replace("RUN", str(half)).replace("OUT", str(tmp_path)) for w in OUTPUTS[name]))
    complains(done, 2, f"{tmp_path / name} is a pipe, not a file")
    assert (tmp_path / name).is_fifo()
    assert not list(tmp_path.glob(f"{files.TEMPORARY}*"))


# A start that fails.


def test_a_start_that_fails_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise Trouble("no")

    for owner, name in (
        (directory, "versions_here"),
        (directory, "make_folders"),
        (files, "write_text"),
        (loop, "Engine"),
        (loop, "Saver"),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(owner, name, fail)
            with pytest.raises(Trouble, match="no"):
                started(tmp_path / "deep" / "run")
        assert not list(tmp_path.iterdir()), name


@pytest.mark.parametrize("number", interrupts.SIGNALS)
def test_a_signal_before_the_first_chunk_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    """Python's handler would raise KeyboardInterrupt in a library, which may swallow it."""

    def press(*_: object) -> dict[str, str]:
        signal.raise_signal(number)
        return {}

    monkeypatch.setattr(directory, "versions_here", press)
    outside = signal.signal(number, signal.default_int_handler)  # `nohup` may have ignored it
    try:
        with pytest.raises(KeyboardInterrupt):
            started(tmp_path / "run")
        assert not list(tmp_path.iterdir())
        assert signal.getsignal(number) is signal.default_int_handler
    finally:
        signal.signal(number, outside)


def test_a_hangup_stays_ignored_as_nohup_asks() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with interrupts.noting() as noted:
            signal.raise_signal(signal.SIGHUP)
            assert not noted
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_start_that_fails_keeps_what_others_put_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        (tmp_path / "mine.txt").write_text("mine")
        raise Trouble("no")

    monkeypatch.setattr(loop, "Engine", fail)
    with pytest.raises(Trouble, match="no"):
        started(tmp_path)
    assert contents(tmp_path) == {str(tmp_path / "mine.txt"): b"mine"}


def test_a_run_that_begins_meanwhile_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The later one of two runs that begin in one folder at once is refused."""
    run, real = tmp_path / "run", directory.versions_here

    def overtaken(*given: object) -> dict[str, str]:
        monkeypatch.setattr(directory, "versions_here", real)
        started(run)
        return real(*given)

    monkeypatch.setattr(directory, "versions_here", overtaken)
    with pytest.raises(InputError, match=r"exists already.*resume"):
        started(run)
    assert here("verify", run).returncode == 0


# A run whose folder is removed or replaced while it goes on.


@pytest.mark.parametrize("replaced", [False, True])
def test_a_run_whose_folder_is_removed_stops(tmp_path: Path, replaced: bool) -> None:
    run, moved = tmp_path / "run", tmp_path / "moved"

    def remove(status: loop.Status) -> None:
        if not moved.exists():
            run.rename(moved)
            if replaced:
                shutil.copytree(moved, run)

    with pytest.raises(Trouble, match=f"{run} was removed or replaced"):
        started(run, remove)
    if replaced:
        assert contents(run).keys() == {path.replace("moved", "run") for path in contents(moved)}
    else:
        assert not run.exists()


def test_a_link_in_place_of_an_unfinished_text_is_not_followed(
    outside: Path, tmp_path: Path
) -> None:
    file = tmp_path / "text.json"
    file.with_name(files.TEMPORARY + file.name).symlink_to(outside / "mine.txt")
    files.replace_text(file, "new")
    assert (file.read_text(), (outside / "mine.txt").read_text()) == ("new", "mine")


def test_a_pipe_in_place_of_a_lock_holds_up_no_reader(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / LOCK)
    assert not directory.is_written(tmp_path)
