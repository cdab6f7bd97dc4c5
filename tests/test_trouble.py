"""What goes wrong is told in one line, damages nothing, and a run can go on afterwards."""

import errno
import json
import os
import resource
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest

from primordia import device
from primordia.disk import checkpoint, directory, files
from primordia.engine import chunk, loop
from primordia.errors import InputError, Trouble
from tests import commands
from tests.commands import begin, complains, here

pytestmark = pytest.mark.usefixtures("compiled_once")

TASK = "CartPole-survival"
HALF, TICKS = 1_500, 4_000
SMALL = (TASK, "--cells", "8", "--hazard", "0.002", "--sample_every", "500", "--quiet")


@pytest.fixture(scope="module")
def through(compiled_once: None, tmp_path_factory: pytest.TempPathFactory) -> str:
    """Digest of the run that never met with trouble."""
    run = tmp_path_factory.mktemp("through") / "run"
    assert here("run", *SMALL, "--ticks", TICKS, "--out", run).returncode == 0
    return digest(run)


@pytest.fixture(scope="module")
def half(compiled_once: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run that was interrupted half-way: two checkpoints, a closed segment and open tails."""
    run = tmp_path_factory.mktemp("half") / "run"
    assert here("run", *SMALL, "--ticks", HALF, "--out", run).returncode == 0
    interrupt_after(run, HALF)
    assert len(checkpoint.numbered(run)) == 2
    assert list((run / "births").iterdir())
    return run


@pytest.fixture
def run(half: Path, tmp_path: Path) -> Path:
    """A copy of it, to be damaged."""
    return Path(shutil.copytree(half, tmp_path / "run"))


def interrupt_after(run: Path, ticks: int) -> None:
    """Go on to TICKS, but press Ctrl-C once so many are reached."""

    def press(status: loop.Status) -> None:
        if int(status.engine.state.world.worlds.tick.lo[0]) > ticks:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        loop.resume(run, {"ticks": TICKS}, listen=press)


def digest(run: Path) -> str:
    done = here("info", run, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["digest"]


def goes_on(run: Path, through: str, *words: str) -> None:
    """It can be resumed, and ends as if nothing had happened."""
    done = here("resume", run, "--ticks", TICKS, "--quiet", *words)
    assert done.returncode == 0, done.stderr
    assert digest(run) == through


def contents(folder: Path) -> dict[str, bytes]:
    """Every file, but for the lock."""
    found = (path for path in folder.rglob("*") if path.is_file() and path.name != "lock")
    return {str(path): path.read_bytes() for path in found}


def flip(path: Path, at: float = 0.5) -> None:
    """Flip one bit."""
    data = bytearray(path.read_bytes())
    data[int(len(data) * at)] ^= 1
    path.write_bytes(data)


# What the user asked for makes no sense: status 2, and no run directory is made.

WRONG = {
    ("CartPole-survivl",): ["no task 'CartPole-survivl'", "did you mean 'CartPole-survival'?"],
    (TASK, "--celsl", "64"): ["no setting 'celsl'", "did you mean 'cells'?"],
    (TASK, "--mutation.scal=1"): ["'mutation.scal'", "did you mean 'mutation.scale'?"],
    (TASK, "--scale", "1"): ["'scale'", "did you mean 'mutation.scale'?"],
    (TASK, "--mutatoin.scale", "1"): ["'mutatoin'", "did you mean 'mutation'?"],
    (TASK, "--habitat.angle_limt", "1"): ["did you mean 'habitat.angle_limit'?"],
    (TASK, "--cells", "many"): ["cells", "integer", "'many'"],
    (TASK, "--cells", "1"): ["cells", "greater than or equal to 2", "1"],
    (TASK, "--cells", "1.5"): ["cells", "integer", "1.5"],
    (TASK, "--seed", "-1"): ["seed", "greater than or equal to 0", "-1"],
    (TASK, "--seed", str(2**64)): ["seed", str(2**64)],
    (TASK, "--seed", str(2**64 - 1), "--seeds", "2"): ["seeds must be below 2^64"],
    (TASK, "--seed", "[1, 2]"): ["seed", "[1, 2]"],
    (TASK, "--seed", "{a = 1}"): ["seed"],
    (TASK, "--seeds", "0"): ["seeds", "greater than or equal to 1"],
    (TASK, "--seeds", "60000", "--cells", "60000"): ["cells x seeds", "2^26"],
    (TASK, "--replication", "1.5"): ["replication", "less than or equal to 1"],
    (TASK, "--replication", "nan"): ["replication", "finite"],
    (TASK, "--mutation.scale", "inf"): ["mutation.scale", "finite"],
    (TASK, "--mutation", "5"): ["mutation", "5"],
    (TASK, "--mutation", "5", "--mutation.scale", "1"): ["--mutation.scale"],
    (TASK, "--mutation.blocks.inptu.scale", "1"): ["no block 'inptu'"],
    (TASK, "--brain.kind", "clever"): ["brain.kind", "'clever'"],
    (TASK, "--motor.kind", "gaussian"): ["motor.kind", "discrete"],
    (TASK, "--placement.topology", "torus4", "--cells", "7"): ["7 cells", "torus"],
    (TASK, "--seasons", '[{kind = "ratchet"}]'): ["seasons.0.ratchet.setting is missing"],
    (TASK, "--habitat.name", "pond"): ["no habitat named 'pond'", "cartpole", "module:Class"],
    (TASK, "--habitat.name", "5"): ["no habitat named 5"],
    (TASK, "--habitat.name", "[]"): ["no habitat named []"],
    (TASK, "--habitat.name", ":Pond"): ["no habitat named ':Pond'"],
    (TASK, "--habitat.name", "no.such:Pond"): ["'no.such:Pond'", "No module named 'no'"],
    (TASK, "--habitat.name", "tests.toys:Pond"): ["'tests.toys:Pond'", "no attribute 'Pond'"],
    (TASK, "--habitat.name", "json:JSONDecoder"): ["JSONDecoder is no habitat", "senses_size"],
    (TASK, "--habitat", "pond"): ["habitat", "'pond'"],
    (TASK, "--cells"): ["--cells needs a value"],
    (TASK, "--cells", "--seed", "3"): ["--cells needs a value"],
    (TASK, "--ticks"): ["'--ticks' requires an argument"],
    (TASK, "--ticks", "0"): ["stop.ticks", "greater than or equal to 1"],
    (TASK, "--until", "bored"): ["stop.until", "'saturation'", "'bored'"],
    (TASK, "64"): ["unexpected extra argument (64)"],
    (TASK, "--device", "gpu"): ["--device", "finds no 'gpu' device"],
    (TASK, "--device", "nonsense"): ["--device", "finds no 'nonsense' device"],
    (TASK, "--checkpoint-every", "-1"): ["--checkpoint-every", "-1"],
    (TASK, "--checkpoint-every", "nan"): ["--checkpoint-every", "nan"],
    (TASK, "--checkpoint-every", "often"): ["--checkpoint-every", "'often'"],
    (): ["Missing argument 'TASK|FILE.toml'"],
    ("no/such/file.toml",): ["no/such/file.toml cannot be read", "No such file"],
}


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_a_wrong_word_on_the_command_line(words: tuple[str, ...], tmp_path: Path) -> None:
    if "gpu" in words and any(each.platform == "gpu" for each in device_list()):
        pytest.skip("there is a GPU here")
    out = tmp_path / "run"
    complains(here("run", "--out", out, *words), 2, *WRONG[words])
    assert not out.exists()


def device_list() -> list[Any]:
    import jax

    return jax.devices()


FILES = {
    "cells = ": "not valid TOML",
    "[mutation\nscale = 1": "not valid TOML",
    "task = 'x'\ntask = 'y'": "not valid TOML",
    f"task = '{TASK}'\nceils = 4": "there is no setting 'ceils'; did you mean 'cells'?",
    f"task = '{TASK}'\n[mutation]\nscael = 4": "did you mean 'mutation.scale'?",
    f"task = '{TASK}'\ncells = '32'": "cells: input should be a valid integer, not '32'",
    f"task = '{TASK}'\nreplication = 2": "replication: input should be less than or equal to 1",
    "cells = 4": "task is missing (and 1 more)",
    "task = []": "task: input should be a valid string, not []",
    "task = 'own'": "habitat is missing",
    "task = 'own'\nhabitat = {}": "no habitat named ''",
}


@pytest.mark.parametrize("text", FILES)
def test_a_wrong_word_in_a_file(text: str, tmp_path: Path) -> None:
    file, out = tmp_path / "mine.toml", tmp_path / "run"
    file.write_text(text)
    complains(here("run", file, "--out", out), 2, str(file), FILES[text])
    assert not out.exists()


def test_files_that_are_no_text(tmp_path: Path) -> None:
    file, folder = tmp_path / "mine.toml", tmp_path / "folder.toml"
    file.write_bytes(b"\xff\x00\xfe")
    folder.mkdir()
    complains(here("run", file), 2, str(file), "not valid TOML")
    complains(here("run", folder), 2, str(folder), "Is a directory")


@pytest.mark.parametrize(
    ("words", "parts"),
    [
        (["frobnicate"], ["No such command 'frobnicate'"]),
        (["info"], ["Missing argument 'RUN'"]),
        (["info", "--yaml", "x"], ["No such option '--yaml'"]),
        (["resume", "--cells", "4", "x"], ["No such option '--cells'"]),
        (["resume", "x", "--ticks"], ["'--ticks' requires an argument"]),
        (["resume", "x", "--ticks", "-5"], ["ticks", "greater than or equal to 1", "-5"]),
        (["resume", "x", "--ticks", "0"], ["ticks", "greater than or equal to 1"]),
        (["resume", "x", "--births", "lots"], ["births", "integer", "'lots'"]),
        (["resume", "x", "--until", "bored"], ["until", "'saturation'", "'bored'"]),
        (["resume", "x", "--checkpoint-every", "-1"], ["--checkpoint-every", "-1"]),
        (["resume", "x", "--device", "nonsense"], ["--device", "'nonsense'"]),
        (["verify", "x", "--device", "nonsense"], ["--device", "'nonsense'"]),
        (["tasks", "more"], ["unexpected extra argument (more)"]),
    ],
)
def test_wrong_words_to_other_commands(words: list[str], parts: list[str]) -> None:
    complains(here(*words), 2, *parts)


def test_no_word_at_all_gives_help() -> None:
    done = here()
    assert done.returncode == 2
    assert "primordia run CartPole-survival" in done.stderr
    assert len(done.stderr.splitlines()) > 10


# What is given as a run is none, or none for this version.


def test_a_directory_that_is_taken(run: Path, tmp_path: Path) -> None:
    before = contents(run)
    taken = here("run", *SMALL, "--ticks", "10", "--out", run)
    complains(taken, 2, str(run), "exists already", "--out", f"primordia resume {run}")
    assert contents(run) == before
    file = tmp_path / "file"
    file.write_text("mine")
    complains(here("run", *SMALL, "--ticks", "10", "--out", file), 2, str(file), "exists already")
    assert file.read_text() == "mine"


@pytest.mark.parametrize("command", ["info", "resume", "verify"])
def test_a_directory_that_is_no_run(command: str, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    before = contents(tmp_path)
    for path in (tmp_path, tmp_path / "nothing", tmp_path / "mine.txt"):
        complains(here(command, path), 2, str(path), "is not a run of primordia")
    assert contents(tmp_path) == before


@pytest.mark.parametrize("command", ["info", "resume", "verify"])
def test_a_run_made_by_a_newer_version(command: str, run: Path) -> None:
    change_versions(run, format=directory.FORMAT + 1)
    before = contents(run)
    complains(here(command, run), 2, str(run), "newer primordia", "upgrade")
    assert contents(run) == before


@pytest.mark.parametrize("text", ["", "{", "[1]", "5", '{"jax": "1"}', '{"format": "x"}', "\udcff"])
def test_garbage_in_place_of_versions(run: Path, text: str) -> None:
    (run / "versions.json").write_bytes(text.encode(errors="surrogateescape"))
    before = contents(run)
    for command in ("info", "resume", "verify"):
        complains(here(command, run), 2, str(run), "versions.json")
    assert contents(run) == before


def test_a_run_without_a_checkpoint_starts_anew(run: Path, through: str) -> None:
    shutil.rmtree(run / "checkpoints")
    complains(here("info", run), 2, str(run), "no checkpoint yet", f"primordia resume {run}")
    complains(here("verify", run), 2, str(run), "no checkpoint yet")
    goes_on(run, through)


def change_versions(run: Path, **change: object) -> None:
    path = run / "versions.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))


@pytest.mark.parametrize(
    "change", [{"jax": "0.0.1"}, {"instruction_set": "x86_64 SSE4_2"}, {"device": "NVIDIA H200"}]
)
def test_a_run_of_other_versions(run: Path, through: str, change: dict[str, str]) -> None:
    ((name, value),) = change.items()
    change_versions(run, **change)
    before = contents(run)
    complains(here("resume", run), 2, str(run), f"{name} {value} then", "now", "--inexact")
    assert contents(run) == before
    done = here("verify", run)
    assert (done.returncode, done.stderr) == (0, ""), "it came out the same all the same"
    goes_on(run, through, "--inexact")
    assert json.loads(here("info", run, "--json").stdout)["exact"] is False
    assert "not exact" in here("info", run).stdout
    complains(here("resume", run), 2, "--inexact")
    complains(here("verify", run), 2, str(run), "not exact")


def test_verify_says_what_differs_and_why_it_might(run: Path) -> None:
    change_versions(run, jax="0.0.1")
    manifest = checkpoint.numbered(run)[-1] / "manifest.json"
    content = json.loads(manifest.read_text())
    content["digests"]["births"][0][0] ^= 1
    content["sha256"] = checkpoint._checksum(content)
    manifest.write_text(json.dumps(content))
    parts = [str(run), "does not hold", "world 0 (seed 0) differs", "jax 0.0.1 then"]
    complains(here("verify", run), 1, *parts)


# Files of a run are damaged.


def newest(run: Path) -> Path:
    return checkpoint.numbered(run)[-1]


def empty(path: Path) -> None:
    path.write_bytes(b"")


def truncate(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-100])


def garble(path: Path) -> None:
    path.write_bytes(b"\xff\xfe garbage \x00")


def miscount(path: Path) -> None:
    """A change that leaves valid JSON."""
    content = json.loads(path.read_text())
    content["progress"]["wall_s"] += 1
    path.write_text(json.dumps(content))


@pytest.mark.parametrize("damage", [flip, truncate, garble, empty, Path.unlink])
def test_a_damaged_state_is_passed_over(
    run: Path, through: str, damage: Callable[[Path], None]
) -> None:
    state = newest(run) / "state.npz"
    damage(state)
    assert here("info", run).returncode == 0
    complains(here("verify", run), 1, str(state))
    done = here("resume", run, "--ticks", TICKS, "--quiet")
    complains(done, 0, "passed over a bad checkpoint", str(state))
    assert digest(run) == through


@pytest.mark.parametrize("damage", [flip, miscount, garble, empty, Path.unlink])
def test_a_damaged_manifest_is_passed_over(
    run: Path, through: str, damage: Callable[[Path], None]
) -> None:
    manifest = newest(run) / "manifest.json"
    damage(manifest)
    done = here("resume", run, "--ticks", TICKS, "--quiet")
    complains(done, 0, "passed over", str(manifest), "missing or damaged")
    assert digest(run) == through


@pytest.mark.parametrize("where", ["births/000000.parquet", "deaths/000000.parquet", "config.toml"])
@pytest.mark.parametrize("damage", [flip, truncate, Path.unlink])
def test_damage_to_what_all_checkpoints_need(
    run: Path, where: str, damage: Callable[[Path], None]
) -> None:
    damage(run / where)
    before = contents(run)
    for command in ("info", "resume", "verify"):
        done = here(command, run)
        assert done.returncode in (1, 2)
        complains(done, done.returncode, str(run / where))
    assert contents(run) == before


def test_the_only_checkpoint_is_damaged(run: Path, through: str, tmp_path: Path) -> None:
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


def test_a_changed_configuration_is_no_longer_that_run(run: Path) -> None:
    config = run / "config.toml"
    config.write_text(config.read_text().replace("seed = 0", "seed = 1"))
    complains(here("resume", run), 1, str(config), "damaged")


@pytest.mark.parametrize("text", ["", "cells = 'x'", "\x00", "task = 5"])
def test_garbage_in_place_of_the_configuration(run: Path, text: str) -> None:
    (run / "config.toml").write_text(text)
    for command in ("info", "resume", "verify"):
        complains(here(command, run), 2, str(run / "config.toml"))


def test_folders_lost_in_a_copy_are_made_again(run: Path, through: str, tmp_path: Path) -> None:
    fresh = tmp_path / "fresh"
    with pytest.raises(KeyboardInterrupt):
        started(fresh, lambda _: signal.raise_signal(signal.SIGINT))
    for folder in ("births", "deaths", "metrics"):
        (fresh / folder).rmdir()
    (fresh / "checkpoints" / "note.txt").write_text("not a checkpoint")
    goes_on(fresh, through)


def started(run: Path, listen: Callable[[loop.Status], None] | None = None) -> None:
    from primordia import config

    settings = {"cells": 8, "hazard": 0.002, "sample_every": 500, "stop": {"ticks": TICKS}}
    loop.start(config.load(TASK, settings), run, checkpoint_every=0.0, listen=listen)


# Nothing can be written.


def test_places_where_no_run_can_be_made(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("mine")
    below = here("run", *SMALL, "--ticks", "10", "--out", file / "run")
    complains(below, 1, str(file / "run"), "cannot be written", "Not a directory")
    nowhere = here("run", *SMALL, "--ticks", "10", "--out", "/proc/run")
    complains(nowhere, 1, "/proc/run", "cannot be written")
    assert file.read_text() == "mine"


def test_a_run_that_may_not_be_written(
    run: Path, through: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = contents(run)
    with monkeypatch.context() as patch:
        patch.setattr(os, "open", refusing(os.open, run))
        complains(here("resume", run), 1, str(run), "cannot be written", "Permission denied")
        assert here("info", run).returncode == 0
    assert contents(run) == before
    goes_on(run, through)


def refusing(real_open: Callable[..., int], below: Path) -> Callable[..., int]:
    """`os.open` that lets nobody write below a path."""

    def refuse(path: str, flags: int, *rest: Any, **named: Any) -> int:
        if flags & (os.O_WRONLY | os.O_RDWR) and str(path).startswith(str(below)):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
        return real_open(path, flags, *rest, **named)

    return refuse


class Disk:
    """A disk that is full from the n-th write on, under everything that writes."""

    def __init__(self, patch: pytest.MonkeyPatch, writes: int) -> None:
        self.left, self.writes = writes, 0
        patch.setattr(np, "savez", self.limited(np.savez))
        patch.setattr(pyarrow.parquet, "write_table", self.limited(pyarrow.parquet.write_table))
        patch.setattr(files, "sync", self.limited(files.sync))
        for name in ("write_text", "rename", "mkdir"):
            patch.setattr(Path, name, self.limited(getattr(Path, name)))

    def limited(self, real: Callable[..., Any]) -> Callable[..., Any]:
        def write(*args: Any, **named: Any) -> Any:
            if named.get("exist_ok"):
                return real(*args, **named)
            self.writes += 1
            if self.writes > self.left:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return real(*args, **named)

        return write


def test_a_disk_that_fills_up_at_any_write(
    half: Path, through: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def tried(writes: int, run: Path) -> int:
        with monkeypatch.context() as patch:
            disk = Disk(patch, writes)
            loop.resume(run, {"ticks": TICKS}, checkpoint_every=0.0)
        return disk.writes

    def copy(name: object) -> Path:
        return Path(shutil.copytree(half, tmp_path / str(name)))

    needed = tried(10**9, copy("enough"))
    assert digest(tmp_path / "enough") == through
    assert needed >= 3 * 8 + 3 * 4, "some checkpoints, and the last segment of each table"
    for writes in range(needed):
        run = copy(writes)
        with pytest.raises(Trouble, match=f"{run}/.* cannot be written: No space left on device"):
            tried(writes, run)
        goes_on(run, through)
        shutil.rmtree(run)


def test_a_disk_that_is_full_from_the_beginning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for writes in range(12):
        with monkeypatch.context() as patch:
            Disk(patch, writes)
            with pytest.raises(Trouble, match="cannot be written: No space left on device"):
                started(tmp_path / str(writes))


@contextmanager
def files_at_most(size: int) -> Iterator[None]:
    """Files of this process cannot grow beyond a size."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_file_that_cannot_grow(run: Path, through: str) -> None:
    with files_at_most(20_000):
        done = here("resume", run, "--quiet")
    complains(done, 1, str(run / "checkpoints"), "cannot be written", "File too large")
    goes_on(run, through)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system with room for one checkpoint and a half."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=128k", "tmpfs", str(folder)]
    if os.getuid() != 0 or shutil.which("mount") is None:
        pytest.skip("needs root, to mount a small file system")
    if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        pytest.skip("no file system can be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_disk_that_is_really_full(small_disk: Path, through: str) -> None:
    run, often = small_disk / "run", ("--checkpoint-every", "0")
    done = here("run", *SMALL, "--ticks", TICKS, "--out", run, *often)
    complains(done, 1, str(run), "cannot be written", "No space left on device")
    assert checkpoint.numbered(run), "it was full before there was a checkpoint"
    assert here("info", run).returncode == 0
    complains(here("resume", run, "--quiet", *often), 1, "No space left on device")
    subprocess.run(["mount", "-o", "remount,size=20m", str(small_disk)], check=True)
    goes_on(run, through)


# Nothing is wrong, but the user should be told.


def test_nothing_to_do_says_how_to_go_on(run: Path, through: str) -> None:
    goes_on(run, through)
    for words in ((), ("--ticks", HALF), ("--ticks", TICKS)):
        done = here("resume", run, "--quiet", *words)
        limit = words[-1] if words else TICKS
        complains(done, 0, "nothing to do", str(run), f"ticks {limit}, until saturation", "--ticks")
        assert digest(run) == through
    more = here("resume", run, "--ticks", TICKS + 1, "--until", "none", "--quiet")
    assert (more.returncode, more.stderr) == (0, "")
    found = json.loads(here("info", run, "--json").stdout)
    assert found["ticks"] == TICKS + 1
    assert found["limits"] == {"ticks": TICKS + 1, "births": None, "until": None}


def test_saturated_worlds_go_on_without_that_limit(tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = (TASK, "--cells", "8", "--habitat.angle_limit", "180", "--habitat.track_limit", "1e9")
    done = here("run", *words, "--saturation_ticks", "50", "--out", run, "--quiet")
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(here("info", run, "--json").stdout)
    assert found["saturation"] == {"tick": found["ticks"], "births": found["births"]}
    complains(here("resume", run, "--ticks", 10_000, "--quiet"), 0, "nothing to do", "--until none")
    more = here("resume", run, "--ticks", 10_000, "--until", "none", "--quiet")
    assert (more.returncode, more.stderr) == (0, "")
    assert json.loads(here("info", run, "--json").stdout)["ticks"] == 10_000


def test_zero_seconds_between_checkpoints_means_after_every_chunk(tmp_path: Path) -> None:
    run, chunks = tmp_path / "run", []
    started(run, lambda _: chunks.append(len(checkpoint.numbered(run))))
    assert len(chunks) > 2
    assert int(newest(run).name) == len(chunks)


def test_weights_that_are_no_numbers_are_a_fault(run: Path) -> None:
    struck = []

    def strike(status: loop.Status) -> None:
        """Let one weight of everybody be NaN, once."""
        if struck:
            return
        world, bodies = status.engine.state
        struck.append(int(world.organisms.alive.sum()))
        genome = world.organisms.genome
        genome = {**genome, "output": genome["output"].at[:, 0, 3].set(float("nan"))}
        world = world._replace(organisms=world.organisms._replace(genome=genome))
        status.engine.state = chunk.State(world, bodies)

    loop.resume(run, {"ticks": TICKS}, listen=strike)
    found = json.loads(here("info", run, "--json").stdout)
    assert found["deaths_by_cause"]["fault"] == struck[0] > 0
    assert found["extinctions"] > 0
    assert f"{struck[0]} fault" in here("info", run).stdout


def test_flags_may_stand_before_the_task(tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = ("--cells", "8", "--hazard=0.002", TASK, "--sample_every", "500", "--quiet")
    done = here("run", *words, "--ticks", 10, "--out", run)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(here("info", run, "--json").stdout)["cells"] == 8


def test_nobody_reads_what_is_printed(half: Path, through: str, tmp_path: Path) -> None:
    """As with `| head -1`."""
    loud = [word for word in SMALL if word != "--quiet"]
    out = tmp_path / "run"
    processes = [begin("info", half), begin("run", *loud, "--ticks", TICKS, "--out", out)]
    for process in processes:
        assert process.stdout is not None
        process.stdout.close()
    for process in processes:
        assert process.stderr is not None
        assert process.stderr.read() == ""
        process.stderr.close()
        assert process.wait(timeout=60) == 1
    goes_on(out, through)


def test_the_python_interface_raises(run: Path, tmp_path: Path) -> None:
    import primordia

    with pytest.raises(InputError, match="did you mean 'cells'"):
        primordia.run(TASK, tmp_path / "new", celsl=3)
    with pytest.raises(InputError, match=r"ticks: .* not -1"):
        primordia.Run(run).resume(ticks=-1)
    with pytest.raises(InputError, match="is not a run"):
        primordia.Run(tmp_path / "none").info()
    assert primordia.Run(run).info() == primordia.Run(str(run)).info()  # type: ignore[arg-type]
    assert device.versions() == {
        name: value for name, value in primordia.Run(run).info()["versions"].items()
        if name != "format"
    }  # fmt: skip
    assert commands.CACHE is not None
