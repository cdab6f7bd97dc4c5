"""Phylogenies: of invented worlds, and of worlds that were lived."""

from pathlib import Path
from typing import Any

from primordia.runs import loop
from tests.worlds import MILLS, config

WORLDS: dict[str, Any] = {**MILLS, "replication": 0.12}
"""Two worlds, in which half of all children are mutants."""


def live(path: Path, ticks: int, **settings: Any) -> Path:
    """Live such worlds, and return their run."""
    loop.start(config({**WORLDS, **settings, "stop": {"ticks": ticks}}), path)
    return path
