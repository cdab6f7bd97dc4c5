"""Tallies of habitats: recorded at each death and in each sample, and no part of the law."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.engine.tallies import Tallies, tally_columns
from primordia.history.summary import summary
from primordia.law.events import Events, Rows
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


CELLS = 4
"""Cells of each of two invented worlds."""


class Scores:
    """A habitat with two tallies in its cells."""

    tallies = "score", "lives"

    def __init__(self) -> None:
        self.now = np.zeros((2 * CELLS, 2), np.int32)

    def tally(self) -> np.ndarray:
        return self.now


def filled_list(*first: int) -> Any:
    """Return a list whose rows begin with these numbers, with unused rows."""
    rows: Any = np.full((len(first) + 3, 2), 50, np.uint32)
    rows[: len(first), 0] = first
    return Rows(rows, np.int32(len(first)))


def read(habitat: Scores, tallies: Tallies, deaths: Rows, samples: Rows) -> tuple:
    """Return the tallies in the rows of deaths (n, 2), and mean and best of both in those of samples."""
    births = filled_list(1, 2)
    given = Events(births, deaths, samples)
    added = tallies.added_to(given)
    assert added.births is births
    died, sampled = (np.asarray(each.rows) for each in added[1:])
    np.testing.assert_array_equal(died[:, :2], np.asarray(deaths.rows)[: int(deaths.filled)])
    np.testing.assert_array_equal(sampled[:, :2], np.asarray(samples.rows)[: int(samples.filled)])
    mean = sampled[:, [2, 4]].copy().view(np.float32)
    return (
        died[:, 2:].view(np.int32).tolist(),
        mean.tolist(),
        sampled[:, [3, 5]].view(np.int32).tolist(),
    )


def mask(*cells: int) -> Any:
    return np.isin(np.arange(2 * CELLS), cells)


def test_tallies_follow_the_rows_of_deaths_and_of_the_worlds_sampled() -> None:
    """Worlds have unequal numbers of organisms. A sample may be of one world, or of an empty one."""
    habitat: Any = Scores()
    tallies = Tallies(habitat, 2)
    habitat.now[:] = [[5, 1], [-7, 2], [8, 3], [100, 4], [-3, 5], [-9, 6], [90, 7], [91, 8]]
    living = mask(0, 1, 2, 4, 5)
    tallies.note_samples(living, filled_list())
    tallies.note_samples(living, filled_list(0, 1))
    tallies.note_deaths(mask(2, 4))
    habitat.now += 1000
    tallies.note_deaths(mask())
    tallies.note_samples(living, filled_list(0, 1))
    tallies.note_deaths(mask(0))
    tallies.note_samples(mask(6), filled_list(0, 1, 1))
    tallies.note_samples(mask(6), filled_list(0, 1, 1, 0))
    assert read(habitat, tallies, filled_list(2, 4, 0), filled_list(0, 1, 1, 0)) == (
        [[8, 3], [-3, 5], [1005, 1001]],
        [[2.0, 2.0], [-6.0, 5.5], [1090.0, 1007.0], [0.0, 0.0]],
        [[8, 3], [-3, 6], [1090, 1007], [0, 0]],
    )


def test_each_chunk_begins_without_tallies() -> None:
    habitat: Any = Scores()
    tallies = Tallies(habitat, 2)
    for score in (3, 4):
        habitat.now[:] = score
        assert read(habitat, tallies, filled_list(), filled_list()) == ([], [], [])
        tallies.note_deaths(mask(1))
        tallies.note_samples(mask(5), filled_list(1))
        once = read(habitat, tallies, filled_list(1), filled_list(1))
        assert once == ([[score] * 2], [[score] * 2], [[score] * 2])
        tallies.begin()


def test_a_sample_has_mean_and_best_of_one_tally_after_the_other() -> None:
    assert tally_columns(Scores.tallies) == ["score_mean", "score_best", "lives_mean", "lives_best"]
