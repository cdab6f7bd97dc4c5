"""Worlds with islands keep the promises, and are the sum of their islands."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import primordia
from primordia.organism.reliving.compare import relive
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.engine.test_strange import assert_lived_alike
from tests.history.test_rebuilding import assert_rebuilt
from tests.strange import TICKS
from tests.worlds import MILL, Lived, config

WHEELS: dict[str, Any] = {
    **MILL,
    "habitat": {
        "name": "tests.toys:Mill",
        "islands": [
            {"name": "mill", "share": 2.0},
            {
                "name": "watch",
                "habitat": {"name": "tests.toys:Watch"},
                "hazard": 0.08,
                "metabolism": {"store": 20.0},
                "mutation": {"scale": 0.01},
                "placement": {"migration": 0.5},
            },
            {"name": "slow", "replication": 0.2},
        ],
    },
    "brain": {"hidden": 2},
    "seeds": 2,
    "replication": 0.4,
    "placement": {"topology": "well-mixed", "rule": "empty-only", "migration": 0.05},
    "seasons": [
        *MILL["seasons"],
        {"kind": "schedule", "setting": "watch.hazard", "at": 150, "value": 0.02},
        {"kind": "schedule", "setting": "placement.migration", "at": 200, "value": 0.3},
        {"kind": "ratchet", "setting": "slow.replication", "when": "mean_age", "above": 1.0,
         "factor": 0.9, "every": 60},
    ],
}  # fmt: skip
"""Two worlds with three islands: two habitats with other senses, actions and random words."""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("islands") / "run"
    loop.start(config(WHEELS, stop={"ticks": TICKS}), path)
    return path


@pytest.mark.slow
def test_a_habitat_on_the_host_lives_the_same_lives() -> None:
    islands = [
        {**island, "habitat": {"name": "tests.toys:Mirror", "inner": inner}}
        for island, inner in zip(
            WHEELS["habitat"]["islands"], ("mill", "watch", "mill"), strict=True
        )
    ]
    lived = Lived(config(WHEELS), TICKS)
    hosted = Lived(config({**WHEELS, "habitat": {"islands": islands}}), TICKS)
    for name in ("births", "deaths", "metrics"):
        mine, other = lived.table(name), hosted.table(name)
        assert mine.keys() == other.keys()
        for column, values in mine.items():
            np.testing.assert_array_equal(values, other[column], column)


def test_organisms_of_every_island_live_again(run: Path) -> None:
    opened = Archive(run)
    lives, islands = opened.lives, opened.config.islands
    home = islands.of_cells(lives.cell)
    for number in range(islands.count):
        for died in (True, False):
            rows = np.flatnonzero((home == number) & (lives.died == died))
            assert len(rows) > 1
            life = relive(opened, int(lives.id[rows[-1]]), int(lives.world[rows[-1]]))
            assert life.agrees, life.respects


def test_a_life_goes_on_from_a_checkpoint_and_in_a_fork(run: Path, tmp_path: Path) -> None:
    before, out = primordia.load(run), tmp_path / "fork"
    fork = Archive(before.fork(200, out, stop={"ticks": TICKS}).path)
    assert_lived_alike(Archive(run), fork)
    assert_rebuilt(fork.path)
    older = np.flatnonzero(fork.lives.inherited & (fork.lives.ended > 200))
    home = fork.config.islands.of_cells(fork.lives.cell[older])
    for number in range(fork.config.islands.count):
        row = older[home == number][-1]
        life = relive(fork, int(fork.lives.id[row]), int(fork.lives.world[row]))
        assert life.begin == "fork"
        assert life.agrees


def test_islands_have_rates_of_their_own(run: Path) -> None:
    deaths, metrics = (primordia.load(run).arrays(name) for name in ("deaths", "metrics"))
    islands = Archive(run).config.islands
    assert islands.sizes == (12, 6, 6)
    early = deaths["tick"] <= 150
    home = islands.of_cells(deaths["cell"])
    struck = (deaths["cause"] == "hazard") & early
    share = [struck[home == k].sum() / early[home == k].sum() for k in range(3)]
    assert share[1] > 4 * max(share[0], share[2])
    seen = np.unique(metrics["watch.hazard"])
    np.testing.assert_allclose(seen, [0.02, 0.08], rtol=1e-6)


@pytest.mark.slow
def test_equal_islands_are_a_plain_world() -> None:
    """To the last bit, on a ring: only the borders are drawn."""
    mills = {**MILL, "brain": {"hidden": 4}, "seeds": 2}
    plain = Lived(config(mills), 200)
    islands = [{"name": "a"}, {"name": "b", "share": 3}, {"name": "c"}]
    drawn = Lived(config({**mills, "habitat": {**MILL["habitat"], "islands": islands}}), 200)
    for name in ("births", "deaths"):
        mine, other = plain.table(name), drawn.table(name)
        for column, values in mine.items():
            np.testing.assert_array_equal(values, other[column], column)


@pytest.mark.slow
def test_one_island_is_a_plain_world() -> None:
    one = config({**MILL, "habitat": {**MILL["habitat"], "islands": [{"name": "only"}]}})
    assert Lived(one, 200).digests() == Lived(config(MILL), 200).digests()
