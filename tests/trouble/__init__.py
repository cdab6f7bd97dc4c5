"""What goes wrong is told in one line, damages nothing, and a run can go on afterwards."""

import json
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from primordia import config
from primordia.runs import checkpoint, loop
from tests.commands import here

TASK = "CartPole-survival"
HALF, TICKS = 1_500, 4_000
SMALL = (TASK, "--cells", "8", "--hazard", "0.002", "--sample_every", "500", "--quiet")


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


def newest(run: Path) -> Path:
    return checkpoint.numbered(run)[-1]


def started(run: Path, listen: Callable[[loop.Status], None] | None = None) -> None:
    settings = {"cells": 8, "hazard": 0.002, "sample_every": 500, "stop": {"ticks": TICKS}}
    loop.start(config.load(TASK, settings), run, checkpoint_every=0.0, listen=listen)
