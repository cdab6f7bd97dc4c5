"""An experiment that is killed again and again, every process of it, ends with the same worlds."""

import os
import random
import signal
import subprocess
import time
from contextlib import suppress
from pathlib import Path

import pytest

from primordia.experiments.campaign import begin
from primordia.runs import loop
from tests import commands
from tests.experiments.meadows import write
from tests.worlds import digests_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("_killed")]
SETTINGS = {"stop": {"ticks": 200_000}, "seeds": 3, "jobs": {"worlds": 1}}


def processes_of(out: Path) -> list[int]:
    """Return the numbers of all processes whose command line names a folder."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if str(out) in (folder / "cmdline").read_text():
                found.append(int(folder.name))
    return found


def kill_all(out: Path) -> None:
    for number in processes_of(out):
        with suppress(ProcessLookupError):
            os.kill(number, signal.SIGKILL)


def test_jobs_end_when_their_command_is_killed(tmp_path: Path) -> None:
    """The command alone is killed: its processes write checkpoints and end by themselves."""
    out = tmp_path / "out"
    words = "experiment", write(tmp_path, **SETTINGS), "--out", out, "--jobs", 1, "--quiet"
    begun = commands.begin(*words)
    while not list(out.glob("*/*/checkpoints/*/manifest.json")):
        assert begun.poll() is None
        time.sleep(0.05)
    begun.kill()
    begun.communicate()
    for _ in range(600):
        if not processes_of(out):
            break
        time.sleep(0.1)
    assert not processes_of(out)


@pytest.mark.parametrize("seed", range(4))
def test_an_experiment_that_is_killed_five_times_has_the_same_worlds(
    tmp_path: Path, seed: int
) -> None:
    """In all, everything is killed 20 times."""
    draws, out = random.Random(seed), tmp_path / "out"
    words = "experiment", write(tmp_path, **SETTINGS), "--out", out, "--checkpoint-every", 0.2
    kills = 0
    while kills < 5:
        begun = commands.begin(*words, "--quiet", session=True)
        try:
            begun.communicate(timeout=draws.uniform(0.5, 4.0))
            break
        except subprocess.TimeoutExpired:
            kill_all(out)
            begun.communicate()
            kills += 1
    done = commands.here(*words, "--quiet")
    assert done.returncode == 0, done.stderr
    assert kills == 5, f"only {kills} kills before the end"
    for arm in begin(out).plan.arms:
        loop.start(arm.config, tmp_path / "alone" / arm.name)
        assert digests_of(out / arm.name) == digests_of(tmp_path / "alone" / arm.name)
