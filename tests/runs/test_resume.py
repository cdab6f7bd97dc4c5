"""Promise 3: a crash costs time, never data."""

import random
import signal
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import primordia
from primordia.errors import InputError
from primordia.history.info import info
from primordia.runs import checkpoint, directory, loop
from primordia.runs.archive import Archive
from primordia.runs.manifest import Progress
from primordia.settings.limits import Stop
from tests.commands import begin, complains, here

WHAT = ("CartPole-survival", "--seeds", "8", "--cells", "64", "--stop.until", "saturation")
TICKS = 30_000
SLOWLY = ("--checkpoint-every", "0.05")


@pytest.fixture(scope="module")
def through(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Return the digests of an undisturbed run."""
    run = tmp_path_factory.mktemp("through") / "run"
    assert here("run", *WHAT, "--ticks", TICKS, "--out", run).returncode == 0
    return digests(run)


def digests(run: Path) -> list[str]:
    return [world["digest"] for world in info(Archive(run))["worlds"]]


def test_checkpoint_intervals_make_no_difference(through: list[str], tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert here("run", *WHAT, "--ticks", TICKS, "--out", run, *SLOWLY).returncode == 0
    assert digests(run) == through


@pytest.mark.parametrize(
    ("every", "expected"),
    [(60, [1, 5, 15, 75, 135]), (7, [1, 5, 12, 19, 26]), (0.5, [0.5, 1.0, 1.5])],
)
def test_a_run_can_be_looked_at_soon_after_its_start(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, every: float, expected: list[float]
) -> None:
    """A run of a clock that ticks every half a second; nothing is written.

    Each checkpoint holds the time spent: that before the run was resumed, and that since then.
    """
    now, saved = [0.0], list[tuple[float, float]]()
    progress = Progress(limits=Stop(), wall_s=20.0, exact=True)
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(checkpoint, "save", lambda *_: saved.append((now[0], progress.wall_s)))
    nothing: Any = SimpleNamespace(arrays=dict)
    saver = loop.Saver(nothing, nothing, tmp_path, progress, every, 0.0, lambda: None)
    while now[0] < expected[-1]:
        now[0] += 0.5
        saver.save_if_due()
    assert saved == [(at, 20 + at) for at in expected]


def test_ticks_added_later_equal_ticks_lived_at_once(through: list[str], tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert here("run", *WHAT, "--ticks", 1_701, "--out", run).returncode == 0
    assert here("resume", run, "--ticks", 2_499).returncode == 0
    assert here("resume", run, "--ticks", TICKS).returncode == 0
    assert digests(run) == through


def interrupted(run: Path, how: signal.Signals, rng: random.Random) -> int:
    """Start a run, disturb it after a random number of checkpoints, and return its exit status."""
    process = begin("run", *WHAT, "--ticks", TICKS, "--out", run, *SLOWLY, "--quiet")
    wanted, deadline = rng.randrange(6), time.monotonic() + 60
    while time.monotonic() < deadline and process.poll() is None:
        known = [path.name for path in run.glob("checkpoints/0*")]
        if known and int(max(known)) >= wanted:
            break
        time.sleep(0.001)
    time.sleep(rng.uniform(0.0, 0.02))
    process.send_signal(how)
    process.communicate(timeout=60)
    return process.returncode


def killed_and_resumed(run: Path, seed: int) -> list[str]:
    status = interrupted(run, signal.SIGKILL, random.Random(seed))
    assert status == -signal.SIGKILL, "the run had ended, so nothing was tested"
    assert info(Archive(run))["worlds"][0]["ticks"] < TICKS
    done = here("resume", run)
    assert done.returncode == 0, done.stderr
    return digests(run)


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))]
)
def test_kill_9_then_resume_equals_never_killed(
    through: list[str], tmp_path: Path, seed: int
) -> None:
    assert killed_and_resumed(tmp_path / "run", seed) == through


def test_ctrl_c_saves_and_says_how_to_resume(through: list[str], tmp_path: Path) -> None:
    run = tmp_path / "run"
    process = begin("run", *WHAT, "--ticks", TICKS, "--out", run, *SLOWLY)
    while not list(run.glob("checkpoints/0*/manifest.json")):
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == 130
    assert stderr.strip() == f"Stopped and saved. Go on with: primordia resume {run}"
    assert info(Archive(run))["worlds"][0]["ticks"] < TICKS
    assert here("resume", run).returncode == 0
    assert digests(run) == through


def test_half_written_files_are_ignored(through: list[str], tmp_path: Path) -> None:
    run = tmp_path / "run"
    half = [run / "checkpoints/.writing-000007/state.npz", run / "births/.writing-000003.parquet"]
    assert here("run", *WHAT, "--ticks", 1_200, "--out", run).returncode == 0
    for junk in half:
        junk.parent.mkdir(exist_ok=True)
        junk.write_bytes(b"half")
    (run / "deaths" / "000099.parquet").write_bytes(b"named by no manifest")
    assert here("resume", run, "--ticks", TICKS).returncode == 0
    assert digests(run) == through
    assert not any(junk.exists() for junk in half)
    assert not (run / "deaths" / "000099.parquet").exists()


def test_a_damaged_newest_checkpoint_is_skipped(through: list[str], tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert here("run", *WHAT, "--ticks", 27_000, "--out", run, *SLOWLY).returncode == 0
    newest = sorted(run.glob("checkpoints/0*"))[-1]
    state = newest / "state.npz"
    damaged = bytearray(state.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    state.write_bytes(damaged)
    done = here("resume", run, "--ticks", TICKS)
    assert done.returncode == 0
    assert "was not used" in done.stderr
    assert str(state) in done.stderr
    assert digests(run) == through


def test_a_run_has_one_writer_at_a_time(tmp_path: Path) -> None:
    run = tmp_path / "run"
    process = begin("run", *WHAT, "--ticks", 10**9, "--out", run)
    while not (run / "versions.json").exists():
        time.sleep(0.01)
    try:
        complains(here("resume", run), 2, str(run), "another process")
    finally:
        process.kill()
        process.communicate()


def test_verify_finds_no_difference_in_a_good_run(tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert here("run", *WHAT, "--ticks", 1_200, "--out", run).returncode == 0
    done = here("verify", run)
    assert (done.returncode, done.stderr) == (0, "")
    assert "is verified" in done.stdout


def test_a_script_begins_a_run_or_goes_on_with_it(tmp_path: Path) -> None:
    """The same words three times: the run is begun, gone on with, and found to have ended."""
    out = tmp_path / "run"
    words = "run", "CartPole-survival", "--cells", 4, "--seed", 3, "--out", out, "--quiet"
    assert here(*words, "--ticks", 100, "--resume").returncode == 0
    for _ in range(2):
        done = here(*words, "--ticks", 200, "--resume")
        assert done.returncode == 0, done.stderr
        assert primordia.load(out).info()["ticks"] == 200
    assert here("resume", out).returncode == 0
    complains(here(*words, "--cells", 5, "--resume"), 2, "cells is 4 there, and 5 here")
    complains(here(*words), 2, "exists already")


def test_what_a_killed_start_has_left_is_no_obstacle(tmp_path: Path) -> None:
    (tmp_path / "run" / "births").mkdir(parents=True)
    (tmp_path / "run" / "config.toml").write_text("half")
    (tmp_path / "run" / directory.UNBEGUN).touch()
    run = primordia.run(
        "CartPole-survival", tmp_path / "run", cells=4, stop={"ticks": 5}, resume=True
    )
    assert run.info()["ticks"] == 5
    with pytest.raises(InputError, match="needs the directory of the run"):
        primordia.run("CartPole-survival", resume=True)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "mine.txt").touch()
    with pytest.raises(InputError, match="is not a run"):
        primordia.run("CartPole-survival", tmp_path / "other", resume=True)
    assert (tmp_path / "other" / "mine.txt").exists()
