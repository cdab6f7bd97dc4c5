"""A run whose organisms live again."""

from collections.abc import Iterator

import pytest

import primordia
from primordia.organism.playing import in_jax
from primordia.runs import loop
from tests.worlds import config


@pytest.fixture(scope="package", autouse=True)
def _loops_of_few_sizes() -> Iterator[None]:
    """Play few games in loops of the size of many, so that few loops are compiled."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(in_jax, "FEWEST", 64)
        yield


@pytest.fixture(scope="session")
def poles(tmp_path_factory: pytest.TempPathFactory) -> primordia.Run:
    """Return two worlds of CartPole in which some organisms live long."""
    path = tmp_path_factory.mktemp("assays") / "poles"
    loop.start(config(seeds=2, cells=16, stop={"ticks": 600}), path)
    return primordia.load(path)
