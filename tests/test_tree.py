"""What is tested is this tree: in this process, and in each process that a test starts."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import primordia
from primordia.pool import workers as pools
from tests import commands

SOURCE = commands.HERE / "src" / "primordia"
WHERE = "import primordia.pool.worker as worker; print(worker.__file__)"


def test_this_process_imports_this_tree() -> None:
    assert Path(primordia.__file__).parent == SOURCE


def test_processes_import_this_tree_from_any_folder(tmp_path: Path) -> None:
    """Those that get the variables of this process, and those that get the same from `commands`."""
    assert commands.environment() == dict(os.environ)
    command = [sys.executable, "-c", WHERE]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert Path(done.stdout.strip()) == SOURCE / "pool" / "worker.py"


def test_workers_import_this_tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They import the simulators of the tests too, which no installed package has, and no file of the
    current folder."""
    monkeypatch.chdir(tmp_path)
    commands.hostile(tmp_path)
    pool = pools.Workers(
        "tests.counters:Place", {"source": str(SOURCE)}, {"same": ("bool", ())}, 1, 1
    )
    pool.reset(np.ones(1, bool))
    assert pool.arrays["same"].tolist() == [True]
    pool.close()
