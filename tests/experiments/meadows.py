"""Small experiments for tests, in a task of tests that any process of the experiment finds."""

from pathlib import Path
from typing import Any

import tomli_w

from tests.worlds import HERD, MEADOW

SHARED: dict[str, Any] = {
    **MEADOW,
    "brain": {"kind": "feed-forward", "hidden": 1},
    "replication": 0.2,
    "saturation_ticks": 20,
    "hazard": 0.01,
    "seed": 3,
    "seeds": 3,
    "stop": {"ticks": 300},
}
ARMS = [{"name": "mild"}, {"name": "harsh", "hazard": 0.05}]


def write(folder: Path, name: str = "meadows", **changes: Any) -> Path:
    """Write an experiment's file, and its task beside it -> the path of the file."""
    folder.mkdir(exist_ok=True)
    task = {name: SHARED[name] for name in ("task", "habitat", "cells")}
    (folder / "meadow.toml").write_text(tomli_w.dumps(task))
    shared = {name: value for name, value in SHARED.items() if name not in task}
    values = {"question": "Is it mild?", "task": "meadow.toml", **shared, "jobs": {"worlds": 2}}
    values = {**values, "arms": ARMS, **changes}
    file = folder / f"{name}.toml"
    kept = {name: value for name, value in values.items() if value is not None}
    file.write_text(tomli_w.dumps(kept))
    return file


def herds(folder: Path, **changes: Any) -> Path:
    """Write an experiment of two jobs, one for each arm, whose worlds are those of `HERD`."""
    changes = {"saturation_ticks": None, "jobs": {"worlds": 3}, **changes}
    return write(folder, **{**HERD, "task": "meadow.toml", "seed": 3, **changes})
