"""Runs with code of their own, begun by one user and given to another."""

import shutil
import sys
from pathlib import Path

import pytest
import tomli_w

import primordia
from primordia import own_code
from primordia.runs import code
from tests.worlds import HOSTED

POND = """
from typing import Any

import numpy as np

from pond_depth import DEPTH
from primordia.habitats import Continuous, HostHabitat, Outcome
from primordia.settings.base import Settings


class Pond(HostHabitat, Settings):
    depth: float = DEPTH
    senses_size: int = 2
    action: Any = Continuous(1)
    words: int = 1
    rate: float = 10.0

    @property
    def versions(self):
        return {"pond": "1"}

    def open(self, cells, watched=False):
        self.__dict__["age"] = np.zeros(cells, np.int32)

    def reset(self, cells, words):
        self.age[cells] = 0
        return np.zeros((len(cells), 2), np.float32)

    def step(self, action, alive):
        self.age[alive] += 1
        senses = np.stack([self.age, 0 * self.age], axis=1).astype(np.float32)
        return senses, Outcome(self.age > 20)

    def save(self):
        return {"age": self.age}

    def load(self, arrays):
        self.age[:] = arrays["age"]
"""

TASK = tomli_w.dumps(
    {
        "task": "pond",
        **HOSTED,
        "habitat": {"name": "pond:Pond"},
        "replication": 0.3,
        "stop": {"ticks": 60, "until": "none"},
    }
)
"""The pond under the law of HOSTED, whose compiled code other tests share."""

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
