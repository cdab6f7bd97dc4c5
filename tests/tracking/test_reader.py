"""The reader of metrics: the identity of each world, and each row once."""

import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.brains.genomes import FOUNDERS
from primordia.errors import Trouble
from primordia.runs import checkpoint
from primordia.tracking import reader
from primordia.tracking.reader import Reader
from tests.worlds import MEADOW, config

RECORDS: dict[Path, tuple[dict[str, Any], int]] = {}
"""Settings and last tick of each invented run."""


class Opened:
    """A run of invented rows: in tick t, world w has 100 w + t organisms."""

    description = SimpleNamespace(model_dump=lambda mode: {"inputs": 4})

    def __init__(self, path: Path) -> None:
        settings, last = RECORDS[path]
        self.path, self.config = path, config({**MEADOW, **settings})
        self.world_seeds = self.config.seed + np.arange(self.config.seeds)
        rows = [(w, tick) for tick in range(10, last + 1, 10) for w in range(self.config.seeds)]
        world, tick = zip(*rows, strict=True)
        living = [100 * w + t for w, t in rows]
        self.metrics = pa.table({"world": world, "tick": tick, "living": living})


@pytest.fixture
def runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Path]:
    """Return runs. Most differ from the first one in one setting, or in none."""
    several = {
        "run": {"seed": 3, "seeds": 2, "stop": {"ticks": 100}},
        "again": {"seed": 3, "seeds": 2, "stop": {"ticks": 100}},
        "alone": {"seed": 4, "seeds": 1, "stop": {"ticks": 100}},
        "longer": {"seed": 3, "seeds": 2, "stop": {"ticks": 200}},
        "zero": {"seed": 0, "stop": {"ticks": 100}},
        "harsh": {"seed": 3, "seeds": 2, "stop": {"ticks": 100}, "hazard": 0.1},
    }
    folders = {name: tmp_path / name for name in several}
    for name, folder in folders.items():
        (folder / checkpoint.FOLDER / "000001").mkdir(parents=True)
        monkeypatch.setitem(RECORDS, folder, (several[name], 40))
    monkeypatch.setattr(reader, "Archive", Opened)
    return folders


def identities(path: Path, arm: str = "") -> dict[str, str]:
    return {world.name: world.identity for world, _ in Reader("all").new({arm: [path]}, False)}


def test_the_identity_of_a_world_depends_on_its_settings_and_founders_but_not_on_limits(
    runs: dict[str, Path],
) -> None:
    known = identities(runs["run"])
    assert [*known] == ["seed-3", "seed-4"]
    assert len({*known.values()}) == 2
    assert all(len(each) == 16 and int(each, 16) >= 0 for each in known.values())
    assert identities(runs["again"]) == identities(runs["longer"]) == known
    assert identities(runs["alone"]) == {"seed-4": known["seed-4"]}
    others = identities(runs["harsh"]), identities(runs["run"], "arm")
    (runs["run"] / FOUNDERS).write_bytes(b"genomes")
    founded = identities(runs["run"])
    (runs["run"] / FOUNDERS).write_bytes(b"Genomes")
    origin = runs["again"] / checkpoint.ORIGIN
    origin.mkdir()
    (origin / checkpoint.MANIFEST).write_text("{}")
    others += founded, identities(runs["run"]), identities(runs["again"])
    assert len({*known.values()}.union(*(each.values() for each in others))) == 12


@pytest.mark.parametrize(
    "change",
    [
        {"cells": 9}, {"replication": 0.5}, {"genesis": "fill"}, {"sample_every": 20},
        {"saturation_ticks": 9}, {"inheritance": "founder"}, {"placement": {"rule": "replacing"}},
    ],
    ids=lambda change: next(iter(change)),
)  # fmt: skip
def test_worlds_with_other_settings_than_limits_have_other_identities(
    change: dict[str, Any], runs: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    settings, last = RECORDS[runs["again"]]
    monkeypatch.setitem(RECORDS, runs["again"], ({**settings, **change}, last))
    one, other = identities(runs["run"]), identities(runs["again"])
    assert not {*one.values()} & {*other.values()}


def test_each_row_of_each_world_and_arm_is_read_once(
    runs: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The arms have equal worlds. A run is read again only after a new checkpoint."""
    arms = {"one": [runs["run"]], "two": [runs["again"]]}
    watched = Reader("both")
    found = {world.name: (world, rows) for world, rows in watched.new(arms, patient=False)}
    assert [*found] == [f"{arm}/seed-{seed}" for arm in ("one", "two") for seed in (3, 4)]
    for name, (world, rows) in found.items():
        seed = int(name[-1])
        ticks = (10, 20, 30, 40)
        assert rows == [{"tick": tick, "living": 100 * (seed - 3) + tick} for tick in ticks]
        assert (world.group, world.settings["seed"]) == ("both", seed)
        assert "seeds" not in world.settings
        assert world.settings["stop"]["ticks"] == 100
    settings, _ = RECORDS[runs["again"]]
    monkeypatch.setitem(RECORDS, runs["again"], (settings, 60))
    assert not list(watched.new(arms, patient=True))
    (runs["again"] / checkpoint.FOLDER / "000002").mkdir()
    later = {world.name: rows for world, rows in watched.new(arms, patient=True)}
    assert [*later] == ["two/seed-3", "two/seed-4"]
    assert [row["tick"] for rows in later.values() for row in rows] == [50, 60] * 2
    assert not list(watched.new(arms, patient=False))
    monkeypatch.setitem(RECORDS, runs["again"], (settings, 70))
    os.utime(runs["again"] / checkpoint.FOLDER / "000002", (1, 1))  # written again after a crash
    last = [row["tick"] for _, rows in watched.new(arms, patient=True) for row in rows]
    assert last == [70, 70]


@pytest.mark.parametrize("error", [Trouble("damaged"), FileNotFoundError("removed")])
def test_a_run_that_cannot_be_read_is_read_later_and_delays_no_other(
    error: Exception, runs: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both runs of the first arm have a world of seed 4. Its rows are equal, and are given once."""
    arms = {"one": [runs["run"], runs["alone"]], "two": [runs["harsh"]]}
    broken = [runs["run"]]

    def opened(path: Path) -> Opened:
        if path in broken:
            raise error
        return Opened(path)

    monkeypatch.setattr(reader, "Archive", opened)
    watched = Reader("all")
    found = [world.name for world, _ in watched.new(arms, patient=True)]
    assert found == ["one/seed-4", "two/seed-3", "two/seed-4"]
    with pytest.raises(type(error)):
        list(watched.new(arms, patient=False))
    broken.clear()
    assert [world.name for world, _ in watched.new(arms, patient=True)] == ["one/seed-3"]


def test_a_run_without_a_checkpoint_is_opened_only_if_nothing_can_follow(
    runs: dict[str, Path],
) -> None:
    (runs["run"] / checkpoint.FOLDER / "000001").rmdir()
    arms, watched = {"late": [runs["run"]], "other": [runs["zero"]]}, Reader("all")
    for patient, names in (
        (True, ["other/seed-0"]),
        (True, []),
        (False, ["late/seed-3", "late/seed-4"]),
    ):
        assert [world.name for world, _ in watched.new(arms, patient)] == names
