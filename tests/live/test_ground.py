"""The view's error threshold is that of the records, as long as it has seen all births."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.history.threshold import Threshold, over_births
from primordia.live import ground
from primordia.live.ground import Ground, Medians, medians
from primordia.runs import loop
from primordia.runs.loop import Status
from tests.worlds import MEADOW, config

SETTINGS: dict[str, Any] = {
    **MEADOW,
    "brain": {"hidden": 3},
    "hazard": 0.05,
    "replication": 0.3,
    "seeds": 3,
}


def lived(folder: Path, followed: list[Ground]) -> primordia.Run:
    """Live a run that is seen chunk by chunk."""

    def listen(status: Status) -> None:
        if not followed:
            followed.append(Ground(status.engine.law.cells, 3))
        followed[0].follow(status.engine.events)

    loop.start(config(SETTINGS, stop={"ticks": 800}), folder, listen=listen)
    return primordia.load(folder)


def test_it_is_measured_as_from_the_records(tmp_path: Path) -> None:
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


def test_worlds_that_tell_nothing_have_no_medians() -> None:
    unknown = Threshold(0, 0.5, None, 2.0)
    assert medians([]) is None
    assert medians([unknown]) is None
    known = Threshold(1, 0.5, 0.2, 2.0)
    assert medians([unknown, known]) == Medians(0.5, 0.2, pytest.approx(1.2))
