"""The error threshold in the view equals that in the records, as long as the view has seen all births."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.history.threshold import Threshold, over_births
from primordia.law.events import BIRTHS, DEATHS, Rows
from primordia.law.world import Cause
from primordia.live import ground
from primordia.live.ground import Ground, Medians, medians
from primordia.runs import loop
from primordia.runs.lives import ALIVE
from primordia.runs.loop import Status
from tests.worlds import HERD, config

SETTINGS: dict[str, Any] = {**HERD, "hazard": 0.05, "replication": 0.3}


def lived(folder: Path, followed: list[Ground]) -> primordia.Run:
    """Live a run while a `Ground` follows its chunks, and add this to `followed`."""

    def listen(status: Status) -> None:
        if not followed:
            followed.append(Ground(status.engine.law.cells, 3))
        followed[0].follow(status.engine.events)

    loop.start(config(SETTINGS, stop={"ticks": 800}), folder, listen=listen)
    return primordia.load(folder)


@pytest.mark.slow
def test_the_threshold_equals_that_in_the_records(tmp_path: Path) -> None:
    followed: list[Ground] = []
    lives = lived(tmp_path / "run", followed).lives()
    ticks = np.full(3, 800)
    worlds = [lives.of_world(world) for world in range(3)]
    expected = [over_births(w, each, np.array([0, len(each)]))[0] for w, each in enumerate(worlds)]
    assert len(lives) < ground.KEPT
    assert followed[0].measured(ticks) == expected
    middle = medians(expected)
    assert middle is not None
    assert middle.held == np.median([each.held for each in expected])


def test_only_the_latest_births_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ground, "KEPT", 300)
    followed: list[Ground] = []
    lives = lived(tmp_path / "run", followed).lives()
    kept = followed[0]._lives(np.full(3, 800))
    order = np.lexsort((lives.cell, lives.world, lives.born))  # of births as events
    np.testing.assert_array_equal(lives.rows_of(kept.world, kept.id), np.sort(order[-300:]))
    rows = lives.rows_of(kept.world, kept.id)
    for name in ("parent", "cell", "birth_cause", "born", "ended", "cause"):
        np.testing.assert_array_equal(getattr(kept, name), getattr(lives, name)[rows], name)


def chunk(births: list[tuple[int, int, int]], deaths: list[tuple[int, int, int, int]]) -> Any:
    """Return events from births (cell, number, tick) of founders and deaths (cell, number, tick, cause).

    Each table also has as many rows that are not filled.
    """
    born, dead = (
        np.array(rows, np.int64).reshape(-1, n).T for rows, n in ((births, 3), (deaths, 4))
    )
    none = np.zeros(len(births), np.int64)
    of_births = dict(zip(("cell", "id", "tick"), born, strict=True))
    of_deaths = dict(zip(("cell", "id", "tick", "cause"), dead, strict=True))
    zeros = np.zeros(len(deaths), np.int64)
    rows = (
        BIRTHS.rows(**of_births, parent=none - 1, cause=none),
        DEATHS.rows(**of_deaths, energy=zeros, food=zeros),
    )
    filled = [Rows(np.vstack([each, np.ones_like(each)]), np.int32(len(each))) for each in rows]
    return SimpleNamespace(births=filled[0], deaths=filled[1])


def test_the_living_end_at_the_tick_of_their_own_world() -> None:
    """Three worlds of two cells are at ticks 9, 1 and 40. No birth in the second world is known."""
    seen = Ground(2, 3)
    seen.follow(chunk([(0, 0, 3), (1, 1, 5), (4, 0, 7)], [(0, 0, 8, Cause.STARVED)]))
    lives = seen._lives(np.array([9, 1, 40]))
    assert lives.world.tolist() == [0, 0, 2]
    assert lives.ended.tolist() == [8, 9, 40]
    assert lives.cause.tolist() == [Cause.STARVED, ALIVE, ALIVE]
    assert lives.cell.tolist() == [0, 1, 0]
    assert [each.world for each in seen.measured(np.array([9, 1, 40]))] == [0, 1, 2]


def test_every_death_of_a_kept_birth_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three births are kept. The first of these organisms dies before four older organisms do."""
    monkeypatch.setattr(ground, "KEPT", 3)
    seen = Ground(2, 2)
    seen.follow(chunk([(0, 0, 0), (1, 1, 0), (2, 0, 0), (3, 1, 0)], []))
    born = [(0, 2, 5), (2, 2, 7), (3, 3, 8)]
    died = [(0, 2, 6), (0, 0, 7), (1, 1, 7), (2, 0, 7), (3, 1, 8), (2, 2, 9), (3, 3, 9)]
    seen.follow(chunk(born[:1], []))
    seen.follow(chunk(born[1:], [(*each, Cause.HAZARD) for each in died]))
    lives = seen._lives(np.array([20, 20]))
    assert (lives.id.tolist(), lives.ended.tolist()) == ([2, 2, 3], [6, 9, 9])
    assert lives.died.all()


def test_the_latest_births_of_a_long_chunk_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ground, "KEPT", 3)
    for sizes in ([9], [1, 8], [8, 1], [2, 2, 2, 3], [3, 3, 3], [4, 0, 5]):
        seen, first = Ground(1, 1), 0
        for size in sizes:
            seen.follow(chunk([(0, n, n) for n in range(first, first + size)], []))
            first += size
        assert seen._lives(np.array([9])).id.tolist() == [6, 7, 8]


def test_medians_are_those_of_the_worlds_in_which_all_numbers_are_known() -> None:
    known = [Threshold(0, 0.1, 0.9, 1.0), Threshold(1, 0.2, 0.1, 2.0), Threshold(2, 0.9, 0.2, 9.0)]
    unknown = Threshold(3, 0.5, None, 2.0)
    assert medians([]) is medians([unknown]) is None
    assert medians([unknown, known[1]]) == Medians(0.2, 0.1, pytest.approx(1.64))
    lost = Threshold(4, 0.4, 0.5, 0.0)
    assert medians([unknown, lost]) == Medians(0.4, 0.5, 0.0), "a line that never lasts is known"
    assert medians([unknown, *known]) == Medians(0.2, 0.2, pytest.approx(1.64))
