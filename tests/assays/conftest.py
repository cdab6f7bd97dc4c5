"""A run whose organisms live again."""

import pytest

import primordia
from primordia.runs import loop
from tests.worlds import config

HEAVY = {"factors": {"gravity": 40.0}}


@pytest.fixture(scope="session")
def poles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return two worlds of CartPole in which some organisms live long."""
    path = tmp_path_factory.mktemp("assays") / "poles"
    loop.start(config(seeds=2, cells=16, stop={"ticks": 600}), path)
    return primordia.load(path)


@pytest.fixture(scope="session")
def isles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return two worlds of poles on two islands; on `heavy` poles fall soon."""
    path = tmp_path_factory.mktemp("assays") / "isles"
    islands = [{"name": "light"}, {"name": "heavy", "share": 3, "habitat": HEAVY}]
    settings = {"genesis": "fill", "habitat": {"islands": islands}, "stop": {"ticks": 300}}
    loop.start(config(seeds=2, cells=16, **settings), path)
    return primordia.load(path)
