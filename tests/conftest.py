from pathlib import Path

import pytest

from tests import commands


@pytest.fixture(autouse=True, scope="session")
def _compiled_code(tmp_path_factory: pytest.TempPathFactory) -> None:
    """One cache of compiled code for all commands that tests run."""
    root = tmp_path_factory.getbasetemp()
    shared = root.parent if root.name.startswith("popen") else root
    commands.CACHE = Path(shared) / "compiled"
