"""A folder with code of the user's own."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.strangers import POND, TASK, forget


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with a task and the code of its habitat; another user has no trust in it."""
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "pond.py").write_text(POND)
    (tmp_path / "mine" / "pond_depth.py").write_text("DEPTH = 3.0\n")
    (tmp_path / "mine" / "task.toml").write_text(TASK)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.chdir(tmp_path / "mine")
    forget()
    yield tmp_path / "mine"
    forget()
