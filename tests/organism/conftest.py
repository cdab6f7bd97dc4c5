"""Runs for all tests of lives: poles and mills, and worlds in which organisms die in every way."""

from pathlib import Path
from typing import Any

import pytest

import primordia
from primordia.runs import loop
from tests.worlds import MILL, config

WAYS: dict[str, Any] = {
    **MILL,
    "cells": 16,
    "hazard": 0.02,
    "brain": {"hidden": 2},
    "placement": {"topology": "torus4", "rule": "replacing"},
    "replication": 0.06,
}
"""A world in which organisms die in every way: hunger, broken wheels, accidents, neighbours."""
CLOCKED = {"name": "tests.toys:Clocked", "inner": "mill"}


@pytest.fixture(
    scope="package", params=["in JAX", pytest.param("on the host", marks=pytest.mark.slow)]
)
def chain(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Make a run of two worlds with seeds of its own, a fork of it, and a fork of the fork."""
    folder = tmp_path_factory.mktemp("chain")
    habitat = CLOCKED if request.param == "on the host" else MILL["habitat"]
    settings = config({**WAYS, "habitat": habitat, "seeds": 2, "seed": 77, "stop": {"ticks": 120}})
    loop.start(settings, folder / "run")
    loop.resume(folder / "run", {"ticks": 150})
    run = primordia.load(folder / "run")
    fork = run.fork(100, folder / "fork", seed=9, stop={"ticks": 200})
    again = fork.fork(180, folder / "again", seed=300, stop={"ticks": 260})
    return [run.path, fork.path, again.path]


@pytest.fixture(scope="package")
def mill(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run of two worlds with a noisy motor and seasons that change the metabolism."""
    run = tmp_path_factory.mktemp("mill") / "run"
    loop.start(config({**MILL, "seeds": 2, "seed": 5, "stop": {"ticks": 700}}), run)
    return run


@pytest.fixture(scope="package")
def poles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("poles") / "run"
    return primordia.run("CartPole-survival", run, stop={"ticks": 6000, "until": "none"}).path
