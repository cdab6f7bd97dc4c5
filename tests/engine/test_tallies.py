"""Tallies of habitats: recorded at each death and in each sample, and no part of the law."""

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


def test_deaths_record_the_tallies_at_death(clocked: Path) -> None:
    """This holds also where a cell is occupied again in the tick of a death."""
    lives, dead = Archive(clocked).lives, primordia.load(clocked).arrays("deaths")
    rows = [lives.row(*pair) for pair in zip(dead["id"], dead["world"], strict=True)]
    assert len(rows) > 100
    np.testing.assert_array_equal(dead["ticks"], lives.lifespan[rows])
    np.testing.assert_array_equal(dead["ticks_down"], -lives.lifespan[rows])


def test_samples_record_mean_and_best_tallies_of_the_living(clocked: Path) -> None:
    samples = primordia.load(clocked).arrays("metrics")
    assert len(samples["tick"]) >= 3 * 8
    np.testing.assert_allclose(samples["ticks_mean"], samples["mean_age"], rtol=1e-6)
    np.testing.assert_array_equal(samples["ticks_best"], samples["oldest_age"])
    np.testing.assert_allclose(samples["ticks_down_mean"], -samples["mean_age"], rtol=1e-6)


def test_info_shows_the_tallies_of_the_living(clocked: Path) -> None:
    info = primordia.load(clocked).info()
    world = info["worlds"][1]
    assert world["tallies"]["ticks"]["best"] == world["oldest_age"]
    lives = Archive(clocked).lives.of_world(1)
    ages = lives.lifespan[~lives.died]
    assert world["tallies"]["ticks"]["median"] == np.median(ages)
    assert f"ticks {np.median(ages):,.0f} (best {ages.max():,})" in summary(info)


def test_tallies_continue_after_a_resume(clocked: Path, tmp_path: Path) -> None:
    parts = tmp_path / "parts"
    loop.start(config({**WORLDS, "stop": {"ticks": 137}}), parts)
    loop.resume(parts, {"ticks": 400})
    whole, again = primordia.load(clocked), primordia.load(parts)
    assert again.table("deaths") == whole.table("deaths")
    assert again.table("metrics") == whole.table("metrics")
    assert again.info()["worlds"][2]["digest"] == whole.info()["worlds"][2]["digest"]


def test_the_law_does_not_depend_on_tallies(clocked: Path, tmp_path: Path) -> None:
    blind = {**WORLDS["habitat"], "name": "tests.toys:Mirror"}
    loop.start(config({**WORLDS, "habitat": blind}), tmp_path / "run")
    same = primordia.load(tmp_path / "run").table("births")
    assert same == primordia.load(clocked).table("births")
