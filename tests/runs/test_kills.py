"""Five hundred kills: a run that is killed again and again ends as if it had never been disturbed.

Each kill comes at a random instant of a command that writes a checkpoint after every chunk: while it
starts, compiles, advances or writes.
"""

import os
import random
import signal
import time
from pathlib import Path

import pytest

from primordia.history.info import info
from primordia.runs.archive import Archive
from tests.commands import begin, here

pytestmark = [
    pytest.mark.slow,
    pytest.mark.usefixtures("_killed"),
    pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="/proc tells what is left"),
]
KILLS, CHAINS = 25, 5
LONGEST = 5.0
"""Seconds from the start of a command within which it is killed."""
LIVELY = ("--hazard", "0.005", "--until", "none", "--quiet", "--cells")
RUNS: dict[str, tuple[str, ...]] = {
    "CartPole": ("CartPole-survival", *LIVELY, "8"),
    "Atari": ("Pong-survival", *LIVELY, "4"),
    "a robot": ("Reacher-forager", *LIVELY, "4"),
    "a fork": ("CartPole-survival", *LIVELY, "8"),
}


def left_by(session: int) -> list[int]:
    """Return the processes that still belong to the session of a killed command."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:  # it has ended meanwhile
            continue
        if int(fields[3]) == session and fields[0] != "Z":
            found.append(int(path.parent.name))
    return found


def killed(words: tuple[object, ...], after: float) -> None:
    """Kill a command `after` seconds after its start, and see all its processes end."""
    process = begin(*words, session=True)
    time.sleep(after)
    process.kill()
    process.communicate(timeout=60)
    assert process.returncode == -signal.SIGKILL, "it had ended by itself"
    deadline = time.monotonic() + 20
    while left := left_by(process.pid):
        assert time.monotonic() < deadline, f"processes go on: {left}"
        time.sleep(0.01)


def begun(kind: str, folder: Path) -> Path:
    """Return a new run of a kind, with a few ticks."""
    assert here("run", *RUNS[kind], "--ticks", 50, "--out", folder / "run").returncode == 0
    if kind != "a fork":
        return folder / "run"
    words = "fork", folder / "run", "--at", 40, "--seed", 3, "--ticks", 60, "--quiet"
    assert here(*words, "--out", folder / "fork").returncode == 0
    return folder / "fork"


def worlds(run: Path) -> list[tuple[int, str]]:
    """Return the ticks and the digest of each world."""
    return [(world["ticks"], world["digest"]) for world in info(Archive(run))["worlds"]]


def lived_to(run: Path, ticks: int) -> list[tuple[int, str]]:
    done = here("resume", run, "--ticks", ticks, "--quiet")
    assert done.returncode == 0, done.stderr
    return worlds(run)


@pytest.mark.parametrize("chain", range(CHAINS))
@pytest.mark.parametrize("kind", RUNS)
def test_a_run_killed_again_and_again_ends_as_if_undisturbed(
    tmp_path: Path, kind: str, chain: int
) -> None:
    draw = random.Random(f"{kind} {chain}")
    (tmp_path / "disturbed").mkdir()
    (tmp_path / "calm").mkdir()
    run = begun(kind, tmp_path / "disturbed")
    before = sorted(os.listdir(tmp_path / "disturbed"))
    advanced = 0
    for _ in range(KILLS):
        ((ticks, _),) = worlds(run)
        words = "resume", run, "--ticks", "none", "--checkpoint-every", "0", "--quiet"
        killed(words, draw.uniform(0.0, LONGEST))
        ((now, _),) = worlds(run)
        assert now >= ticks
        advanced += now > ticks
    assert advanced > KILLS // 10, "hardly any kill met a run that had advanced"
    assert sorted(os.listdir(tmp_path / "disturbed")) == before
    end = worlds(run)[0][0] + 100
    assert lived_to(run, end) == lived_to(begun(kind, tmp_path / "calm"), end)
