"""A run whose organisms live again."""

import pytest

import primordia
from primordia.runs import loop
from tests.worlds import config


@pytest.fixture(scope="session")
def poles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return two worlds of CartPole in which some organisms live long."""
    path = tmp_path_factory.mktemp("assays") / "poles"
    loop.start(config(seeds=2, cells=16, stop={"ticks": 600}), path)
    return primordia.load(path)
