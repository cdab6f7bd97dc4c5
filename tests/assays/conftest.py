"""Runs whose organisms live again."""

import pytest

import primordia
from primordia.runs import loop
from tests.engine.test_islands import WHEELS
from tests.worlds import config


@pytest.fixture(scope="session")
def poles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return an arm of two worlds of CartPole in which some organisms live long."""
    path = tmp_path_factory.mktemp("assays") / "poles"
    for seed in range(2):
        own = config(seed=seed, cells=8, hazard=0.002, stop={"ticks": 600, "until": "none"})
        loop.start(own, path / str(seed))
    return primordia.load(path)


@pytest.fixture(scope="session")
def isles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return two worlds of three islands: `mill` and `slow` have one habitat, `watch` another."""
    path = tmp_path_factory.mktemp("assays") / "isles"
    loop.start(config(WHEELS, stop={"ticks": 200}), path)
    return primordia.load(path)
