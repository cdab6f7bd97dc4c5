"""What habitats count for people: noted at each death and in each sample, and no part of the law."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.history.summary import summary
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.worlds import config

WORLDS: dict[str, Any] = {
    "task": "clocked",
    "cells": 8,
    "seeds": 3,
    "hazard": 0.02,
    "replication": 0.1,
    "sample_every": 50,
    "stop": {"ticks": 400},
    "habitat": {"name": "tests.toys:Clocked", "angle_limit": 90.0},
}


@pytest.fixture(scope="module")
def clocked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    run = tmp_path_factory.mktemp("clocked") / "run"
    loop.start(config(WORLDS), run)
    return run


def test_the_dead_have_what_they_came_to(clocked: Path) -> None:
    """Also those whose cell is taken again in the tick of their death."""
    everyone, dead = Archive(clocked).lives, primordia.load(clocked).arrays("deaths")
    rows = [everyone.row(*pair) for pair in zip(dead["id"], dead["world"], strict=True)]
    assert len(rows) > 100
    np.testing.assert_array_equal(dead["ticks"], everyone.lifespan[rows])
    np.testing.assert_array_equal(dead["ticks_down"], -everyone.lifespan[rows])


def test_samples_have_mean_and_best_of_the_living(clocked: Path) -> None:
    samples = primordia.load(clocked).arrays("metrics")
    assert len(samples["tick"]) >= 3 * 8
    np.testing.assert_allclose(samples["ticks_mean"], samples["mean_age"], rtol=1e-6)
    np.testing.assert_array_equal(samples["ticks_best"], samples["oldest_age"])
    np.testing.assert_allclose(samples["ticks_down_mean"], -samples["mean_age"], rtol=1e-6)


def test_info_tells_of_the_living(clocked: Path) -> None:
    found = primordia.load(clocked).info()
    world = found["worlds"][1]
    assert world["tallies"]["ticks"]["best"] == world["oldest_age"]
    everyone = Archive(clocked).lives.of_world(1)
    ages = everyone.lifespan[~everyone.died]
    assert world["tallies"]["ticks"]["median"] == np.median(ages)
    assert f"ticks {np.median(ages):,.0f} (best {ages.max():,})" in summary(found)


def test_a_run_that_was_stopped_counts_on(clocked: Path, tmp_path: Path) -> None:
    parts = tmp_path / "parts"
    loop.start(config({**WORLDS, "stop": {"ticks": 137}}), parts)
    loop.resume(parts, {"ticks": 400})
    whole, again = primordia.load(clocked), primordia.load(parts)
    assert again.table("deaths") == whole.table("deaths")
    assert again.table("metrics") == whole.table("metrics")
    assert again.info()["worlds"][2]["digest"] == whole.info()["worlds"][2]["digest"]


def test_the_law_never_sees_them(clocked: Path, tmp_path: Path) -> None:
    blind = {**WORLDS["habitat"], "name": "tests.toys:Mirror"}
    loop.start(config({**WORLDS, "habitat": blind}), tmp_path / "run")
    same = primordia.load(tmp_path / "run").table("births")
    assert same == primordia.load(clocked).table("births")
