"""The last line of an experiment's results: the day, the versions and the limits."""

import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from primordia.experiments.results import made
from primordia.runs.directory import VERSIONS

NOON = 1_700_000_000 + 12 * 3600
DAY = 24 * 3600


def arm(folder: Path, name: str, day: int, version: str, **limits: int | None) -> Any:
    """Return what `made` reads of an arm of two runs; the second run began a day later."""
    paths = []
    for number in range(2):
        file = folder / f"{name}-{number}" / VERSIONS
        file.parent.mkdir()
        file.touch()
        os.utime(file, (NOON + (day + number) * DAY,) * 2)
        paths.append(file.parent)
    progress = SimpleNamespace(limits=list(limits.items()))
    return SimpleNamespace(paths=paths, versions={"jax": version}, progress=progress)


def test_what_all_arms_share_is_told_once(tmp_path: Path) -> None:
    arms = [
        arm(tmp_path, "a", 3, "1", ticks=500, births=None, until=40),
        arm(tmp_path, "b", 1, "1", ticks=500, births=None, until=40),
    ]
    told = "Run on 2023-11-16 with jax 1. Each world stopped at: ticks 500 or until 40."
    assert made("ab", arms) == told


def test_what_differs_between_arms_is_told_with_their_names(tmp_path: Path) -> None:
    arms = [
        arm(tmp_path, "a", 0, "1", ticks=500),
        arm(tmp_path, "b", 0, "1, 2", ticks=900),
        arm(tmp_path, "c", 0, "1", ticks=500),
    ]
    assert made("abc", arms) == (
        "Run on 2023-11-15 with jax 1 (a, c); jax 1, 2 (b)."
        " Each world stopped at: ticks 500 (a, c); ticks 900 (b)."
    )
