"""Promise 3: a crash costs time, never data."""

import signal
import time
from pathlib import Path

import pytest

import primordia
from primordia.errors import InputError
from primordia.runs import checkpoint, directory, loop
from primordia.runs.arrays import world_ticks
from tests.commands import begin, complains, here
from tests.trouble import contents
from tests.worlds import MILLS, config, digests_of

FEW, ENDLESS = 3_000, 10**9
"""Ticks of runs."""
SLOWLY = ("--checkpoint-every", "0.05")


@pytest.fixture(scope="module")
def mill(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the file of a task: two worlds with seasons, a metabolism and a noisy motor."""
    file = tmp_path_factory.mktemp("task") / "mill.toml"
    file.write_text(config(MILLS).to_toml())
    return file


@pytest.fixture(scope="module")
def through(mill: Path, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Return the digests of an undisturbed run."""
    return digests_of(lived(mill, tmp_path_factory.mktemp("through") / "run", FEW))


def lived(mill: Path, run: Path, ticks: int, *words: object) -> Path:
    """Live a run in this process."""
    done = here("run", mill, "--ticks", ticks, "--out", run, "--quiet", *words)
    assert (done.returncode, done.stderr) == (0, "")
    return run


def test_ticks_added_later_equal_ticks_lived_at_once(
    mill: Path, through: list[str], tmp_path: Path
) -> None:
    """What was lived before is not lived again."""
    run, ticks = lived(mill, tmp_path / "run", 1_701), list[int]()

    def listen(status: loop.Status) -> None:
        ticks.append(int(world_ticks(status.engine.arrays()).min()))

    for before, then in ((1_701, 2_499), (2_499, FEW)):
        ticks.clear()
        assert loop.resume(run, {"ticks": then}, listen=listen) == []
        assert before < ticks[0] <= ticks[-1] == then
    assert digests_of(run) == through


def killed(mill: Path, run: Path) -> int:
    """Start a run, kill it after its first checkpoint, and return its exit status.

    While it lives, the run has one writer. It finds compiled code that a run in this process has left,
    so it is not killed while it writes such code.
    """
    process = begin("run", mill, "--ticks", ENDLESS, "--out", run, *SLOWLY, "--quiet")
    try:
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and process.poll() is None:
            if list(run.glob("checkpoints/0*")):
                break
            time.sleep(0.01)
        process.send_signal(signal.SIGSTOP)
        complains(here("resume", run), 2, str(run), "another process")
    finally:
        process.kill()
        process.communicate(timeout=60)
    return process.returncode


@pytest.mark.usefixtures("through")
def test_kill_9_then_resume_equals_never_killed(mill: Path, tmp_path: Path) -> None:
    """`test_kills.py` has many more kills."""
    run = tmp_path / "run"
    assert killed(mill, run) == -signal.SIGKILL
    until = primordia.load(run).info()["worlds"][0]["ticks"] + 1_000
    done = here("resume", run, "--ticks", until)
    assert done.returncode == 0, done.stderr
    assert digests_of(run) == digests_of(lived(mill, tmp_path / "through", until))


def test_a_script_begins_a_run_or_goes_on_with_it(mill: Path, tmp_path: Path) -> None:
    """The same words three times: the run is begun, gone on with, and found to have ended."""
    out = tmp_path / "run"
    words = "run", mill, "--seed", 3, "--out", out, "--quiet"
    assert here(*words, "--ticks", 100, "--resume").returncode == 0
    for _ in range(2):
        done = here(*words, "--ticks", 200, "--resume")
        assert done.returncode == 0, done.stderr
        assert primordia.load(out).info()["worlds"][1]["ticks"] == 200
    assert here("resume", out).returncode == 0
    complains(here(*words, "--cells", 9, "--resume"), 2, "cells is 16 there, and 9 here")
    before = contents(out)
    complains(here(*words), 2, "exists already", "--out", f"primordia resume {out}")
    assert contents(out) == before


def test_what_a_killed_start_has_left_is_no_obstacle(mill: Path, tmp_path: Path) -> None:
    (tmp_path / "run" / "births").mkdir(parents=True)
    (tmp_path / "run" / "config.toml").write_text("half")
    (tmp_path / "run" / directory.UNBEGUN).touch()
    heard: list[float] = []
    for ticks, births in ((5, 10_000), (9, None)):  # begun, and gone on with
        run = primordia.run(
            str(mill), tmp_path / "run", stop={"ticks": ticks, "births": births}, resume=True,
            checkpoint_every=0.0, listen=lambda status: heard.append(status.wall_s),
        )  # fmt: skip
        assert run.info()["worlds"][0]["ticks"] == ticks
        assert run.info()["limits"]["births"] == births, (
            "a limit that is not given again is removed"
        )
    assert int(checkpoint.numbered(run.path)[-1].name) == len(heard) + 1, (
        "after all chunks and ends"
    )
    with pytest.raises(InputError, match="needs the directory of the run"):
        primordia.run("CartPole-survival", resume=True)
