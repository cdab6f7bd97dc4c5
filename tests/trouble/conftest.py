"""Runs that tests interrupt and damage."""

import shutil
from pathlib import Path

import pytest

from primordia.runs import checkpoint
from tests.commands import here
from tests.trouble import HALF, SMALL, TICKS, digest, interrupt_after


@pytest.fixture(scope="session")
def through(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the digest of the undisturbed run."""
    run = tmp_path_factory.mktemp("through") / "run"
    assert here("run", *SMALL, "--ticks", TICKS, "--out", run).returncode == 0
    return digest(run)


@pytest.fixture(scope="session")
def half(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run that was interrupted half-way: two checkpoints, a closed segment and open tails."""
    run = tmp_path_factory.mktemp("half") / "run"
    assert here("run", *SMALL, "--ticks", HALF, "--out", run).returncode == 0
    interrupt_after(run, HALF)
    assert len(checkpoint.numbered(run)) == 2
    assert list((run / "births").iterdir())
    return run


@pytest.fixture
def run(half: Path, tmp_path: Path) -> Path:
    """Copy the interrupted run, so that a test may damage it."""
    return Path(shutil.copytree(half, tmp_path / "run"))
