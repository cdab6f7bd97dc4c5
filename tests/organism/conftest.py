"""Runs for all tests of lives: poles and mills, and worlds in which organisms die in every way."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import primordia
from primordia.organism.reliving.on_host import LifeOnHost
from primordia.runs import loop
from tests.worlds import MILLS, config

CALM = {"hazard": 0.002}
"""A chance of accidents with which organisms of MILLS live longer."""
CLOCKED = {"name": "tests.toys:Clocked", "inner": "mill"}


@pytest.fixture(scope="package", autouse=True)
def _short_stretches() -> Iterator[None]:
    """Live lives on the host again in short stretches, so that most lives take several."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(LifeOnHost, "TICKS", 20)
        yield


@pytest.fixture(
    scope="session", params=["in JAX", pytest.param("on the host", marks=pytest.mark.slow)]
)
def chain(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Make a run of two worlds with seeds of its own, a fork of it, and a fork of the fork."""
    folder = tmp_path_factory.mktemp("chain")
    habitat = CLOCKED if request.param == "on the host" else MILLS["habitat"]
    settings = config({**MILLS, "habitat": habitat, "seed": 77, "stop": {"ticks": 120}})
    loop.start(settings, folder / "run")
    loop.resume(folder / "run", {"ticks": 150})
    run = primordia.load(folder / "run")
    fork = run.fork(100, folder / "fork", seed=9, stop={"ticks": 200})
    again = fork.fork(180, folder / "again", seed=300, stop={"ticks": 260})
    return [run.path, fork.path, again.path]


@pytest.fixture(scope="session")
def mill(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of two worlds with a noisy motor and seasons that change the metabolism."""
    run = tmp_path_factory.mktemp("mill") / "run"
    loop.start(config({**MILLS, **CALM, "seed": 5, "stop": {"ticks": 700}}), run)
    return run


@pytest.fixture(scope="session")
def poles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a world of poles, in which an organism lives long."""
    run = tmp_path_factory.mktemp("poles") / "run"
    stop = {"ticks": 6000, "until": "none"}
    return primordia.run("CartPole-survival", run, cells=8, hazard=0.002, seed=3, stop=stop).path
