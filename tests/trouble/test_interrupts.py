"""Ctrl-C, SIGTERM and SIGHUP at any instant: one line, and nothing is lost."""

import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from primordia import files, interrupts
from primordia.cli import commands
from primordia.runs.directory import VERSIONS
from tests.commands import begin, environment, here
from tests.trouble import SMALL, TICKS, goes_on

pytestmark = pytest.mark.skipif(
    not Path("/proc/self/status").exists(), reason="tells when a process handles signals"
)
OFTEN = ("--checkpoint-every", "0")
COMMANDS: dict[str, tuple[object, ...]] = {
    "run": ("run", *SMALL, "--ticks", TICKS, *OFTEN, "--out", "RUN"),
    "resume": ("resume", "RUN", "--ticks", TICKS, *OFTEN),
    "fork": ("fork", "RUN", "--at", 1_000, *OFTEN, "--out", "OUT/fork"),
    "plot": ("plot", "RUN", "--out", "OUT"),
    "replay": ("replay", "RUN", "--out", "OUT/life.mp4"),
    "export": ("export", "RUN", "OUT/genome.safetensors"),
    "info": ("info", "RUN"),
    "phylogeny": ("phylogeny", "RUN", "--out", "OUT/phylogeny.parquet"),
    "verify": ("verify", "RUN"),
}
LONGEST = {"run": 3.0, "resume": 3.0, "fork": 3.0, "plot": 2.0, "replay": 2.0}
"""Seconds within which commands are interrupted, many before they have ended; 0.7 for others."""


def interrupted(words: tuple[object, ...], how: signal.Signals, after: float) -> tuple[int, str]:
    """Send a signal to a command `after` seconds after it begins to handle signals.

    Returns:
        its exit status and stderr.
    """
    process = begin(*words)
    status = Path(f"/proc/{process.pid}/status")
    while process.poll() is None and not handles(status, how):
        time.sleep(0.002)
    time.sleep(after)
    process.send_signal(how)
    try:
        _, err = process.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        process.kill()
        _, err = process.communicate()
        raise AssertionError(f"{words} went on after the signal: {err}") from None
    return process.returncode, err


def handles(status: Path, how: signal.Signals) -> bool:
    """Return whether a process has begun to handle a signal, before which Python ends it in its way."""
    caught = status.read_text(encoding="utf-8").partition("SigCgt:")[2].split()[0]
    return int(caught, 16) >> (signal.SIGTERM - 1) & 1 == 1


def survives(half: Path, through: str, folder: Path, name: str, rng: random.Random) -> int:
    """Interrupt a command at a random instant and assert that nothing is lost -> its exit status."""
    run, out, fresh = folder / "run", folder / "out", name == "run"
    out.mkdir()
    if not fresh:
        shutil.copytree(half, run)
    words = [str(word).replace("RUN", str(run)).replace("OUT", str(out)) for word in COMMANDS[name]]
    how, after = rng.choice(interrupts.SIGNALS), rng.uniform(0.0, LONGEST.get(name, 0.7))
    status, err = interrupted(tuple(words), how, after)
    if status == 0:
        assert err == ""
    else:
        assert status == interrupts.STATUS, err
        assert err.startswith("Stopped")
        assert err.count("\n") == 1, err
    assert not list(out.rglob(f"{files.TEMPORARY}*"))
    assert (
        "Go on with" not in err or (out / "fork" / VERSIONS).exists() or (run / VERSIONS).exists()
    )
    if fresh and not run.exists():
        assert status == interrupts.STATUS
    elif name != "fork":
        goes_on(run, through)
    return status


@pytest.mark.parametrize(
    ("name", "times"),
    [("run", 1), *(pytest.param(name, 20, marks=pytest.mark.slow) for name in COMMANDS)],
)
def test_a_command_that_is_interrupted_says_one_line_and_loses_nothing(
    half: Path, through: str, tmp_path: Path, name: str, times: int
) -> None:
    statuses = []
    for seed in range(times):
        (tmp_path / str(seed)).mkdir()
        rng = random.Random(f"{name}{seed}")
        statuses.append(survives(half, through, tmp_path / str(seed), name, rng))
    assert statuses.count(interrupts.STATUS) >= times // 4


HOSTED = {
    "an Atari game": ("Pong-survival", "--cells", "4"),
    "a robot": ("Hopper-survival", "--cells", "4"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", HOSTED)
def test_runs_with_worker_processes_are_interrupted_at_many_instants(
    tmp_path: Path, name: str
) -> None:
    for seed in range(20):
        run, after = tmp_path / str(seed), random.Random(seed).uniform(0.0, 10.0)
        words = ("run", *HOSTED[name], "--until", "none", "--quiet", *OFTEN, "--out", run)
        status, err = interrupted(words, signal.SIGINT, after)
        assert (status, err.count("\n")) == (interrupts.STATUS, 1), err
        assert err.startswith("Stopped")
        assert run.exists() == ("Go on with" in err)
        if run.exists():
            done = here("info", run)
            assert (done.returncode, done.stderr) == (0, "")


def process(script: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Run a script in another process."""
    command = [sys.executable, "-c", script, *words]
    return subprocess.run(command, env=environment(), capture_output=True, text=True, timeout=60)


DEFERRED = """
import os, select, signal, sys, threading, time
from primordia import interrupts

looked, wait = threading.Semaphore(0), select.select
times = [float(each.partition("@")[2]) for each in sys.argv[1:]]
now, due = 0.0, float("inf")

def look(*given):
    *what, patience = given
    if patience is not None and now + patience < due:
        return [], [], []
    looked.release()
    return wait(*what)

select.select, time.monotonic = look, lambda: now
interrupts.end_commands_at_once()
with interrupts.deferred():
    for each, at, then in zip(sys.argv[1:], times, [*times[1:], due]):
        looked.acquire()
        now, due = at, then
        os.kill(os.getpid(), getattr(signal, each.partition("@")[0]))
    looked.acquire()
print("finished")
"""
"""Work that sends signals to its own process, each at a second of a clock that leaps from one to the
next, and that ends when the last of them has had its effect. It takes longer than the time after
which the first signal is answered with a line."""
STOPPING = "Stopping after the present step; press Ctrl-C once more to stop at once\n"


@pytest.mark.parametrize(
    ("signals", "outcome"),
    [
        (["SIGINT@0", "SIGTERM@9"], (interrupts.STATUS, "", f"{STOPPING}Stopped\n")),
        (["SIGINT@0", "SIGTERM@2"], (interrupts.STATUS, "", "Stopped\n")),
        (["SIGTERM@0", "SIGTERM@1.5"], (0, "finished\n", STOPPING)),
        (["SIGINT@0", "SIGINT@1.5", "SIGINT@3"], (interrupts.STATUS, "", "Stopped\n")),
    ],
)
def test_a_signal_ends_work_that_has_deferred_one_for_two_seconds(
    signals: list[str], outcome: tuple[int, str, str]
) -> None:
    """Two that come at once are one. Impatience ends work no later."""
    done = process(DEFERRED, *signals)
    assert (done.returncode, done.stdout, done.stderr) == outcome


def test_a_command_that_a_signal_ends_waits_for_its_end_before_it_says_what_failed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    said: list[object] = []

    def fail(**_: object) -> None:
        interrupts._ending.append(True)
        raise OSError("its file is gone")

    def pause() -> None:
        said.append("waited")
        interrupts._ending.clear()

    monkeypatch.setattr(signal, "pause", pause)
    monkeypatch.setattr(commands, "commands", fail)
    monkeypatch.setattr(commands, "report", lambda error: said.append(str(error)))
    assert commands.execute() == 1
    assert said == ["waited", "its file is gone"]


LAST = """
import os
from primordia import interrupts

class Last:
    def __init__(self):
        self.kill, self.process, self.signals = os.kill, os.getpid(), interrupts.SIGNALS

    def __del__(self):
        for number in self.signals:
            self.kill(self.process, number)

interrupts.end_commands_at_once()
last = Last()
"""
"""A program to which signals come when the interpreter clears its modules, long after `atexit`."""


def test_a_signal_in_the_last_instant_changes_nothing() -> None:
    done = process(LAST)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
