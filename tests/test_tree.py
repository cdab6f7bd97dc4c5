"""What is tested is this tree: in this process, and in each process that a test starts."""

import subprocess
import sys
from collections.abc import Iterator
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


def environments() -> Iterator[dict[str, str] | None]:
    """Yield the variables of processes that tests start; None: those of this process."""
    yield None
    yield commands.environment()


@pytest.mark.parametrize("number", range(2))
def test_processes_import_this_tree_from_any_folder(number: int, tmp_path: Path) -> None:
    variables = [*environments()][number]
    command = [sys.executable, "-c", WHERE]
    done = subprocess.run(
        command, env=variables, cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert Path(done.stdout.strip()) == SOURCE / "pool" / "worker.py"


def test_workers_import_this_tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They import the simulators of the tests too, which no installed package has."""
    monkeypatch.chdir(tmp_path)
    pool = pools.Workers(f"{__name__}:Place", {}, {"same": ("bool", ())}, 1, 1)
    pool.reset(np.ones(1, bool))
    assert pool.arrays["same"].tolist() == [True]
    pool.close()


class Place:
    """A simulator that reports whether its process imports this tree."""

    def __init__(self, arrays: dict[str, np.ndarray]) -> None:
        self._arrays = arrays

    def make(self, cell: int) -> None:
        self._arrays["same"][cell] = False

    def reset(self, cell: int) -> None:
        self._arrays["same"][cell] = Path(pools.__file__) == SOURCE / "pool" / "workers.py"
