"""Worlds whose counts of ticks and births exceed 32 bits live as worlds that start at 0 do."""

import numpy as np
import pytest

from tests.chronicle import History
from tests.worlds import CLOCKWORK, RING, Lived, config

SHORTLY_BEFORE_2_32 = (2**32 - 50, 2**32 - 100)
BEGINNINGS = [(10**12, 2**33), SHORTLY_BEFORE_2_32, (2**62, 2**52)]


@pytest.fixture(scope="module")
def from_zero() -> Lived:
    return Lived(config(CLOCKWORK), 200)


@pytest.mark.parametrize("start", BEGINNINGS)
def test_a_clockwork_that_starts_late_runs_the_same(
    from_zero: Lived, start: tuple[int, int]
) -> None:
    tick, births = start
    late = Lived(config(CLOCKWORK), tick + 200, start=start)
    for name, ids in (("births", births), ("deaths", births)):
        expected, actual = from_zero.table(name), late.table(name)
        assert len(expected["id"]) > 100
        for column, values in expected.items():
            shift = {"id": ids, "tick": tick}.get(column, 0)
            at = actual[column].tolist() if shift else actual[column]
            np.testing.assert_array_equal(
                at, [v + shift for v in values.tolist()] if shift else values
            )


@pytest.mark.parametrize("start", BEGINNINGS)
def test_samples_are_at_the_same_multiples(start: tuple[int, int]) -> None:
    """Samples are at every tenth tick since 0, wherever a world started, with ages counted from birth."""
    tick, births = start
    metrics = Lived(config(CLOCKWORK), tick + 200, start=start).table("metrics")
    for world in range(2):
        in_world = metrics["world"] == world
        at = [t for t in range(tick + 1, tick + 201) if t % 10 == 0]
        assert metrics["tick"][in_world].tolist() == at
        lived = np.array([t - tick for t in at])
        np.testing.assert_array_equal(metrics["population"][in_world], 16)
        np.testing.assert_array_equal(metrics["oldest_age"][in_world], lived % 31)
        np.testing.assert_array_equal(metrics["mean_age"][in_world], lived % 31)
        np.testing.assert_array_equal(metrics["mean_energy"][in_world], 30.5 - lived % 31)
        np.testing.assert_array_equal(metrics["organism_ticks"][in_world], 16 * lived)
        np.testing.assert_array_equal(metrics["deaths_starved"][in_world], lived // 31 * 16)
        born = [births + 16 * (1 + t // 31) for t in lived.tolist()]
        assert metrics["births"][in_world].tolist() == born


@pytest.mark.parametrize("start", BEGINNINGS[:2])
def test_late_worlds_keep_the_rules_of_every_world(start: tuple[int, int]) -> None:
    """Random draws differ, since ticks do; the rules are the same."""
    run = Lived(config(RING), start[0] + 1, start=start)
    run.change({"replication": 0.2, "hazard": 0.09})
    run.advance_to(start[0] + 500)
    worlds = [History(run, world, start) for world in range(4)]
    for history in worlds:
        assert history.lives[0].born == start[0]
        assert history.now == start[0] + 500
        assert start[1] + len(history.lives) > 2**32
        then, state = history.fixation(), run.engine.state.world.worlds.fixed
        fixed = int(state.hi[history.world]) << 32 | int(state.lo[history.world])
        assert fixed == (2**64 - 1 if then is None else then[0])
    assert len({tuple(life.cell for life in history.lives[:9]) for history in worlds}) == 4
