"""Failures: each gives one line of message and damages nothing, and the run can be resumed.

This file offers runs that were interrupted, damage to files, and the check that a run can be resumed.
"""

import json
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from primordia import config, files
from primordia.runs import checkpoint, loop, manifest
from tests.commands import here

TASK = "CartPole-survival"
HALF, TICKS = 1_500, 4_000
Arrays = dict[str, np.ndarray]
SMALL = (TASK, "--cells", "8", "--hazard", "0.002", "--quiet")


def interrupt_after(run: Path, ticks: int) -> None:
    """Resume a run to TICKS, but press Ctrl-C after `ticks`."""

    def press(status: loop.Status) -> None:
        if np.asarray(status.engine.state.world.worlds.tick.lo)[0] > ticks:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        loop.resume(run, {"ticks": TICKS}, listen=press)


def digest(run: Path) -> str:
    """Return the digest that `info` prints."""
    done = here("info", run, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["digest"]


def goes_on(run: Path, through: str, *words: str) -> None:
    """Assert that a run can be resumed and ends with the digest of an undisturbed run."""
    done = here("resume", run, "--ticks", TICKS, "--quiet", *words)
    assert done.returncode == 0, done.stderr
    assert digest(run) == through


def contents(folder: Path) -> dict[str, bytes]:
    """Return the content of every file except the lock."""
    paths = (path for path in folder.rglob("*") if path.is_file() and path.name != "lock")
    return {str(path): path.read_bytes() for path in paths}


def flip(path: Path) -> None:
    """Flip one bit, or add one to an empty file."""
    data = bytearray(path.read_bytes())
    data = data or bytearray(1)
    data[len(data) // 2] ^= 1
    path.write_bytes(data)


def reseal(folder: Path, change: Callable[[dict[str, Any]], object] | None = None) -> None:
    """Change the manifest of a checkpoint, and seal all files as they are now, like a forger."""
    path, run = folder / "manifest.json", folder.parents[folder.name != "origin"]
    content = json.loads(path.read_text())
    del content["sha256"]
    content["state"] = files.seal(folder / "state.npz")
    content["inputs"] = {
        name: files.seal(run / name) for name in content["inputs"] if (run / name).is_file()
    }
    for table, segments in content["segments"].items():
        for each in segments:
            if (run / table / each["name"]).is_file():
                each |= files.seal(run / table / each["name"])
    if change is not None:
        change(content)
    path.write_text(json.dumps({**content, "sha256": manifest._checksum(content)}))


def rewrite(folder: Path, change: Callable[[Arrays], object]) -> None:
    """Change the arrays of a checkpoint, and seal it again."""
    with np.load(folder / "state.npz") as stored:
        arrays = dict(stored)
    change(arrays)
    np.savez(folder / "state.npz", allow_pickle=True, **arrays)
    reseal(folder)


def recount(arrays: Arrays, name: str, number: int) -> None:
    """Give a count of all worlds a number of 64 bits."""
    arrays[f"world.worlds.{name}.hi"][:] = number >> 32
    arrays[f"world.worlds.{name}.lo"][:] = number & 0xFFFFFFFF


def newest(run: Path) -> Path:
    """Return the newest checkpoint."""
    return checkpoint.numbered(run)[-1]


def started(run: Path, listen: Callable[[loop.Status], None] | None = None) -> None:
    """Live a run to TICKS, with a checkpoint after every chunk."""
    settings = {"cells": 8, "hazard": 0.002, "stop": {"ticks": TICKS}}
    loop.start(config.load(TASK, settings), run, checkpoint_every=0.0, listen=listen)
