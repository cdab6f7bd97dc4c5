"""Ticks lived for each death: compared with counting, and in runs that never saturate."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import primordia
from primordia.comparison.pace import LATE, WINDOWS, pace
from primordia.runs import loop
from tests.commands import here
from tests.synthetic import LIVED, alive, world_of
from tests.worlds import HERD, config

TICKS = 7
"""ticks of a window"""
LIFESPAN = HERD["habitat"]["lifespan"]


@given(LIVED, LIVED, st.integers(0, 20))
def test_every_tick_and_every_death_counts_once(
    one: list[tuple[int, int, bool]], other: list[tuple[int, int, bool]], since: int
) -> None:
    worlds = [world_of(lived, until=110) for lived in (one, other)]
    measured = pace(
        [world.recorded_since(since) for world in worlds], since, since + WINDOWS * TICKS
    )
    for number, world in enumerate(worlds):
        for window in range(WINDOWS):
            ticks = range(since + window * TICKS, since + (window + 1) * TICKS)
            lived = sum(alive(world, row, tick) for row in range(len(world)) for tick in ticks)
            ended = world.ended[world.died] - 1
            assert measured.lived[number, window] == lived
            assert measured.deaths[number, window] == np.isin(ended, ticks).sum()
    late = measured.lived[:, -LATE:].sum(1), measured.deaths[:, -LATE:].sum(1)
    assert (measured.late.known == (late[1] > 0)).all()
    assert (measured.late.value == late[0] / np.maximum(late[1], 1)).all()
    assert (measured.curve == measured.lived / np.maximum(measured.deaths, 1)).all()


@pytest.mark.slow
def test_worlds_that_never_saturate_are_compared_by_ticks_for_each_death(tmp_path: Path) -> None:
    """They are the mean lifespan where accidents kill, or age. Saturation is not mentioned."""
    runs, hazards = [], {"rough": 0.04, "mild": 0.01}
    for (name, hazard), ticks in zip(hazards.items(), (600, 700), strict=True):
        settings = {**HERD, "hazard": hazard, "replication": 0.2, "stop": {"ticks": ticks}}
        runs.append(tmp_path / name)
        loop.start(config(settings), runs[-1])
    arms = primordia.compare(*runs).arms
    for arm, hazard in zip(arms, hazards.values(), strict=True):
        assert arm.pace.edges[-1] == 600
        lifespan = (1 - (1 - hazard) ** LIFESPAN) / hazard
        assert np.median(arm.measured["pace"].value) == pytest.approx(lifespan, rel=0.2)
    assert (arms[1].measured["longest"].value == LIFESPAN).all()
    printed = here("compare", *runs, "--out", tmp_path / "figures").stdout
    assert "ticks lived for each death, late" in printed
    assert "births to" not in printed
    assert (tmp_path / "figures" / "compare.png").stat().st_size > 10_000
