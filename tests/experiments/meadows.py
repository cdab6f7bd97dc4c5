"""Small experiments for tests, in a task of tests that any process of the experiment finds."""

from pathlib import Path
from typing import Any

import tomli_w

from tests.worlds import HERD, MEADOW, MILLS

THREE: dict[str, Any] = {
    **MILLS,
    "replication": 0.2,
    "hazard": 0.01,
    "seed": 3,
    "seeds": 3,
    "stop": {"ticks": 300},
}
"""Mills whose compiled code is that of the runs in `tests/runs`, for one, two or three worlds."""
ARMS = [{"name": "mild"}, {"name": "harsh", "hazard": 0.05}]


def write(folder: Path, name: str = "mills", **changes: Any) -> Path:
    """Write an experiment's file, and its task beside it -> the path of the file."""
    return written(folder, name, THREE, {*MILLS} - {"hazard"}, {"jobs": {"worlds": 2}, **changes})


def herds(folder: Path, **changes: Any) -> Path:
    """Write an experiment of two jobs, one for each arm, whose worlds are those of `HERD`."""
    changes = {"seed": 3, "stop": {"ticks": 300}, "jobs": {"worlds": 3}, **changes}
    return written(folder, "meadows", HERD, {*MEADOW}, changes)


def written(
    folder: Path, name: str, worlds: dict[str, Any], task: set[str], changes: dict[str, Any]
) -> Path:
    """Write an experiment with these worlds, of whose settings `task` names those of the task."""
    folder.mkdir(exist_ok=True)
    file, place = folder / f"{name}.toml", f"{worlds['task']}.toml"
    own = {key: value for key, value in worlds.items() if key in task}
    (folder / place).write_text(tomli_w.dumps(own))
    shared = {key: value for key, value in worlds.items() if key not in task}
    values = {"question": "Is it mild?", "task": place, **shared, "arms": ARMS, **changes}
    kept = {key: value for key, value in values.items() if value is not None}
    file.write_text(tomli_w.dumps(kept))
    return file
