"""A run and its forks."""

from pathlib import Path

import pytest

import primordia
from tests.phylogeny import live


@pytest.fixture(scope="session")
def family(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run, its fork and a fork of that, without changes, and a fork with another seed."""
    folder = tmp_path_factory.mktemp("family")
    run = primordia.load(live(folder / "run", 300))
    fork = run.fork(100, folder / "fork")
    fork.fork(200, folder / "again", stop={"ticks": 300})
    fork.fork(200, folder / "other", seed=77, stop={"ticks": 300})
    return folder
