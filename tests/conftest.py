from collections.abc import Iterator
from pathlib import Path

import pytest

from primordia import loop, verify
from tests import commands, worlds


@pytest.fixture(autouse=True, scope="session")
def _compiled_code(tmp_path_factory: pytest.TempPathFactory) -> None:
    """One cache of compiled code for all commands that tests run."""
    root = tmp_path_factory.getbasetemp()
    shared = root.parent if root.name.startswith("popen") else root
    commands.CACHE = Path(shared) / "compiled"


@pytest.fixture(scope="module")
def compiled_once() -> Iterator[None]:
    """Runs in this process share what is compiled where only seeds and limits differ."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(loop, "Engine", worlds.engine)
        patch.setattr(verify, "Engine", worlds.engine)
        yield
