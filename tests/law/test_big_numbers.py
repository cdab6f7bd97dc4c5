"""Worlds whose counts of ticks and births exceed 32 bits live as worlds that start at 0 do."""

from functools import cache

import numpy as np
import pytest

from tests.worlds import CLOCKWORK, Lived, config

SHORTLY_BEFORE_2_32 = (2**32 - 50, 2**32 - 100)
BEGINNINGS = [SHORTLY_BEFORE_2_32, (2**62, 2**52)]


@cache
def clockwork(start: tuple[int, int] = (0, 0)) -> Lived:
    return Lived(config(CLOCKWORK), start[0] + 200, start=start)


@pytest.mark.parametrize("start", BEGINNINGS)
def test_a_clockwork_that_starts_late_runs_the_same(start: tuple[int, int]) -> None:
    tick, births = start
    for name in ("births", "deaths"):
        expected, actual = clockwork().table(name), clockwork(start).table(name)
        assert len(expected["id"]) > 100
        for column, values in expected.items():
            shift = {"id": births, "tick": tick}.get(column, 0)
            at = actual[column].tolist() if shift else actual[column]
            np.testing.assert_array_equal(
                at, [v + shift for v in values.tolist()] if shift else values
            )


@pytest.mark.parametrize("start", BEGINNINGS)
def test_samples_are_at_the_same_multiples(start: tuple[int, int]) -> None:
    """Samples are at every tenth tick since 0, wherever a world started, with ages counted from birth."""
    tick, births = start
    metrics = clockwork(start).table("metrics")
    for world in range(3):
        in_world = metrics["world"] == world
        at = [t for t in range(tick + 1, tick + 201) if t % 10 == 0]
        assert metrics["tick"][in_world].tolist() == at
        lived = np.array([t - tick for t in at])
        born = [births + 24 * (1 + t // 31) for t in lived.tolist()]
        assert metrics["births"][in_world].tolist() == born
        for name, values in {
            "population": 24,
            "oldest_age": lived % 31,
            "mean_age": lived % 31,
            "mean_energy": 30.5 - lived % 31,
            "organism_ticks": 24 * lived,
            "deaths_starved": lived // 31 * 24,
        }.items():
            np.testing.assert_array_equal(metrics[name][in_world], values, name)
