"""Tallies of invented worlds, at each death and in each sample; `test_strange` has those of lives."""

from typing import Any

import numpy as np

from primordia.engine.tallies import Tallies, tally_columns
from primordia.law.events import Events, Rows

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
