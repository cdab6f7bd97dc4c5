"""Settings of a small run for bundles, and a place for the copies that are made of them."""

import tempfile
from collections.abc import Iterator
from typing import Any

import pytest

from tests.worlds import MILLS

SETTINGS: dict[str, Any] = {**MILLS, "stop": {"ticks": 60}}


@pytest.fixture(scope="module", autouse=True)
def temporary_files(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Give this module a folder of its own for temporary files, in which copies of bundles are made."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(tempfile, "tempdir", str(tmp_path_factory.mktemp("temporary")))
        yield
