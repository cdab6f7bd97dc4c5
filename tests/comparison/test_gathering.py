"""Food in comparisons of runs: by windows of the compared time, and in its last quarter."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.comparison.pace import gathering
from primordia.law.metabolism import ONE


def run(tick: np.ndarray, food: np.ndarray, lived: np.ndarray) -> Any:
    """Return a stand-in for a run of two worlds, by their sums at the ticks of the samples, (2, n)."""
    worlds = np.repeat([0, 1], len(tick))
    columns = {"world": worlds, "tick": np.tile(tick, 2), "food": food.ravel()}
    ends = {"tick": np.full(2, tick[-1]), "food": food[:, -1] * ONE, "organism_ticks": lived[:, -1]}
    return SimpleNamespace(
        metrics=pa.table({**columns, "organism_ticks": lived.ravel()}),
        origin=None,
        count=lambda name: ends[name.removeprefix("world.worlds.")],
    )


def test_late_food_is_that_of_the_last_quarter() -> None:
    """The compared time is ticks 24 to 144, so each of its 12 windows ends with a sample."""
    draw, span = np.random.default_rng(2), 50.0
    tick = np.array([0, *range(24, 145, 10)])
    food, lived = draw.integers(1, 99, (2, 2, len(tick) - 1)) * [[[1]], [[100]]]
    sums = (np.insert(np.cumsum(each, axis=1), 0, 0, axis=1) for each in (food, lived))
    found = gathering(run(tick, *sums), 2, 24, 144, span)
    np.testing.assert_allclose(found.curve, span * food[:, 1:] / lived[:, 1:])
    late = food[:, -3:].sum(axis=1) / lived[:, -3:].sum(axis=1)
    np.testing.assert_allclose(found.late.value, span * late)
    assert found.late.known.all()


def test_metrics_are_not_read_if_no_world_gathered_food() -> None:
    tick = np.arange(0, 121, 10)
    unfed = run(tick, np.outer([0, 0], tick), np.outer([5, 5], tick))
    unfed.metrics = None
    found = gathering(unfed, 2, 0, 120, 10)
    assert (found.late.value.tolist(), found.late.known.tolist()) == ([0, 0], [False, False])
    assert np.isnan(found.curve).all()
    assert found.curve.shape == (2, 12)


@pytest.mark.parametrize(("begin", "known"), [(0, True), (50, True), (60, False)])
def test_late_food_is_zero_if_the_compared_time_has_earlier_food(begin: int, known: bool) -> None:
    """No food is gathered after tick 60. If the comparison begins there, late food is unknown."""
    tick = np.arange(0, 181, 10)
    food = np.outer([2, 0], np.minimum(tick, 60))
    found = gathering(run(tick, food, np.outer([5, 5], tick)), 2, begin, 180, 10)
    assert (found.late.value.tolist(), found.late.known.tolist()) == ([0, 0], [known] * 2)
