"""Runs with code of their own, begun by one user and given to another."""

import shutil
import sys
from pathlib import Path

import pytest

import primordia
from primordia import own_code
from primordia.runs import code

POND = """
from typing import Any

import jax.numpy as jnp

from pond_depth import DEPTH
from primordia.habitats import Discrete, JaxHabitat, Outcome
from primordia.settings.base import Settings


class Pond(JaxHabitat, Settings):
    depth: float = DEPTH
    senses_size: int = 1
    action: Any = Discrete(2)
    words: int = 1
    rate: float = 10.0

    def reset(self, words):
        return jnp.zeros((len(words), 1), jnp.float32)

    def sense(self, bodies):
        return bodies

    def step(self, bodies, action):
        bodies = bodies + 1
        return bodies, Outcome(fatal=bodies[:, 0] > 20, food=None, effort=None)
"""

TASK = """
task = "pond"
cells = 8
habitat = { name = "pond:Pond" }
replication = 0.3
[stop]
ticks = 60
until = "none"
"""

PARTS = ("pond.py", "pond_depth.py")

LIVING = [
    ["resume", "{run}", "--ticks", "70", "--quiet"],
    ["verify", "{run}"],
    ["fork", "{run}", "--at", "30", "--out", "{new}", "--quiet"],
    ["evaluate", "{run}", "--ticks", "30", "--games", "2"],
]


def forget(*modules: str) -> None:
    """Act as another process, which has not imported the code: that of the pond, or some modules."""
    for name in modules or ("pond", "pond_depth"):
        sys.modules.pop(name, None)
        own_code._admitted.sources.pop(name, None)
        code._trusted.clear()


_lived: dict[tuple[bytes, ...], Path] = {}
"""Folders with a run and the user's trust, by the files that the run was begun with."""


def begun(folder: Path) -> Path:
    """Begin a run, in a folder whose parent has the user's trust. A run of the same files is a copy."""
    run, state = folder / "run", folder.parent / "state"
    files = tuple(path.read_bytes() for path in sorted(folder.iterdir()))
    if files not in _lived:
        primordia.run(str(folder / "task.toml"), run)
        forget()
        _lived[files] = folder.parent / "lived"
        shutil.copytree(run, _lived[files] / "run")
        shutil.copytree(state, _lived[files] / "state")
        return run
    shutil.copytree(_lived[files] / "state", state)
    return Path(shutil.copytree(_lived[files] / "run", run))


def elsewhere(folder: Path, run: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give the run to another user, who works in an empty folder."""
    other = folder.parent / "other"
    other.mkdir()
    shutil.copytree(run, other / "run")
    monkeypatch.chdir(other)
    monkeypatch.setenv("XDG_STATE_HOME", str(other / "state"))
    return other / "run"


def words(command: list[str], run: Path) -> list[str]:
    return [word.format(run=run, new=run.parent / "new") for word in command]
