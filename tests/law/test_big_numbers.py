"""Worlds whose counts of ticks and births do not fit in 32 bits live as those that begin at 0."""

import numpy as np
import pytest

from tests.chronicle import History
from tests.worlds import CLOCKWORK, MEADOW, MILL, Lived, config

SHORTLY_BEFORE_2_32 = (2**32 - 50, 2**32 - 100)
BEGINNINGS = [(10**12, 2**33), SHORTLY_BEFORE_2_32, (2**62, 2**52)]


@pytest.fixture(scope="module")
def from_zero() -> Lived:
    return Lived(config(CLOCKWORK), 200)


@pytest.mark.parametrize("begun", BEGINNINGS)
def test_a_clockwork_begun_late_runs_the_same(from_zero: Lived, begun: tuple[int, int]) -> None:
    tick, births = begun
    late = Lived(config(CLOCKWORK), tick + 200, begun=begun)
    for name, ids in (("births", births), ("deaths", births)):
        expected, found = from_zero.table(name), late.table(name)
        assert len(expected["id"]) > 100
        for column, values in expected.items():
            shift = {"id": ids, "tick": tick}.get(column, 0)
            at = found[column].tolist() if shift else found[column]
            np.testing.assert_array_equal(
                at, [v + shift for v in values.tolist()] if shift else values
            )


@pytest.mark.parametrize("begun", BEGINNINGS)
def test_samples_come_at_the_same_multiples(begun: tuple[int, int]) -> None:
    """Every tenth tick since 0, wherever a world began, with ages that know where."""
    tick, births = begun
    metrics = Lived(config(CLOCKWORK), tick + 200, begun=begun).table("metrics")
    for world in range(2):
        mine = metrics["world"] == world
        at = [t for t in range(tick + 1, tick + 201) if t % 10 == 0]
        assert metrics["tick"][mine].tolist() == at
        lived = np.array([t - tick for t in at])
        np.testing.assert_array_equal(metrics["population"][mine], 16)
        np.testing.assert_array_equal(metrics["oldest_age"][mine], lived % 31)
        np.testing.assert_array_equal(metrics["mean_age"][mine], lived % 31)
        np.testing.assert_array_equal(metrics["mean_energy"][mine], 30.5 - lived % 31)
        np.testing.assert_array_equal(metrics["organism_ticks"][mine], 16 * lived)
        np.testing.assert_array_equal(metrics["deaths_starved"][mine], lived // 31 * 16)
        born = [births + 16 * (1 + t // 31) for t in lived.tolist()]
        assert metrics["births"][mine].tolist() == born


@pytest.mark.parametrize("begun", BEGINNINGS[:2])
def test_late_worlds_keep_the_rules_of_every_world(begun: tuple[int, int]) -> None:
    """Random draws differ, as ticks do; rules do not."""
    values = {"cells": 12, "seeds": 3, "replication": 0.2, "hazard": 0.09}
    run = Lived(config(MEADOW, **values), begun[0] + 500, begun=begun)
    worlds = [History(run, world, begun) for world in range(3)]
    for history in worlds:
        assert history.lives[0].born == begun[0]
        assert history.now == begun[0] + 500
        assert begun[1] + len(history.lives) > 2**32
        then, state = history.fixation(), run.engine.state.world.worlds.fixed
        fixed = int(state.hi[history.world]) << 32 | int(state.lo[history.world])
        assert fixed == (2**64 - 1 if then is None else then[0])
    assert len({tuple(life.cell for life in history.lives[:9]) for history in worlds}) == 3


def test_ratchets_look_at_the_same_multiples_beyond_2_32() -> None:
    begun = SHORTLY_BEFORE_2_32
    run = Lived(config(MILL, seeds=2), begun[0] + 700, begun=begun)
    metrics = run.table("metrics")
    gains: set[float] = set()
    replications: set[float] = set()
    for world in range(2):
        history = History(run, world, begun)
        assert history.lives[-1].born > 2**32
        mine = {column: values[metrics["world"] == world] for column, values in metrics.items()}
        ticks = mine["tick"].tolist()
        periodic = [t for t in range(begun[0], begun[0] + 701) if t % 100 == 0]
        assert set(periodic) <= set(ticks)
        assert all(t % 100 == 0 or t % 70 == 0 or t % 50 == 0 for t in ticks)
        for column, every, seen in (
            ("metabolism.gain", 70, gains),
            ("replication", 50, replications),
        ):
            start = {"metabolism.gain": 3.0, "replication": 0.05}[column]
            before = np.concatenate([[np.float32(start)], mine[column][:-1]])
            changed = [t for t, moved in zip(ticks, mine[column] != before, strict=True) if moved]
            assert all(t % every == 0 for t in changed)
            seen.update(changed)
    assert gains
    assert replications
    assert max(gains | replications) > 2**32
