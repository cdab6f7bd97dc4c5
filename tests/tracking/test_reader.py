"""Which worlds and rows dashboards are given, under which names and times, and how long a look takes."""

import signal
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.brains.genomes import FOUNDERS
from primordia.errors import InputError
from primordia.runs import checkpoint
from primordia.tracking import reader, tensorboard
from primordia.tracking.reader import Reader, World
from primordia.tracking.tensorboard import TensorBoard
from primordia.tracking.track import Sources, track
from primordia.tracking.weights_and_biases import WeightsAndBiases
from tests.dashboards import events, offline_records
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
    """Begin runs that differ from the first one in one setting each."""
    several = {
        "run": {"seed": 3, "seeds": 2, "stop": {"ticks": 100}},
        "again": {"seed": 3, "seeds": 2, "stop": {"ticks": 100}},
        "alone": {"seed": 4, "seeds": 1, "stop": {"ticks": 100}},
        "longer": {"seed": 3, "seeds": 2, "stop": {"ticks": 200}},
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


def test_a_world_has_one_identity_whatever_its_limits_and_the_worlds_beside_it(
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


def test_each_world_of_each_arm_has_its_rows_once(
    runs: dict[str, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The arms have the same worlds. A run is read again when it has a new checkpoint."""
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


def test_a_run_of_wandb_has_ticks_as_its_axis_and_nothing_of_the_machine(tmp_path: Path) -> None:
    board = WeightsAndBiases(tmp_path)
    board.add(World("seed-1", "2" * 16, "g", {"seed": 1}), [{"tick": 10, "living": 3}])
    (opened,) = board._open.values()
    for about in ("machine_info", "meta", "stats"):
        assert getattr(opened.settings, f"x_disable_{about}"), "samples of it come after seconds"
    assert opened.settings.disable_git
    assert opened.settings.disable_code
    board.close()
    (records,) = offline_records(tmp_path)
    axes = {
        record.metric.name or record.metric.glob_name: record.metric.step_metric
        for record in records
        if record.HasField("metric")
    }
    assert axes == {"tick": "", "*": "tick"}
    (about,) = (record.run for record in records if record.HasField("run"))
    assert (about.run_id, about.HasField("git")) == ("2" * 16, False)
    assert about.host == "unnamed"
    assert {record.WhichOneof("record_type") for record in records} == {
        *("header", "run", "metric", "history", "summary", "telemetry", "exit")
    }
    assert not [path for path in tmp_path.glob("wandb/*/files/**/*") if path.is_file()]


def test_events_have_the_time_at_which_they_are_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = iter((1234.5, 2345.5))
    monkeypatch.setattr(tensorboard, "time", SimpleNamespace(time=lambda: next(now)))
    board, world = TensorBoard(tmp_path), World("seed-1", "0" * 16, "g", {})
    board.add(world, [{"tick": 10, "living": 3.0}, {"tick": 20, "living": 4.0}])
    board.add(world, [{"tick": 30, "living": 5.0}])
    board.close()
    found = [(event.wall_time, event.step) for event in events(tmp_path / "seed-1")]
    assert found == [(1234.5, 10), (1234.5, 20), (2345.5, 30)]


@pytest.mark.parametrize("name", ["events.out.tfevents.1", "notes.primordia-{0}", "z"])
def test_only_files_of_the_same_world_are_replaced(name: str, tmp_path: Path) -> None:
    """With any other file in the folder, nothing is removed."""
    world, row = World("seed-1", "1" * 16, "g", {}), {"tick": 10, "living": 3.0}
    for _ in range(2):
        board = TensorBoard(tmp_path)
        board.add(world, [row])
        board.close()
    (own,) = (tmp_path / "seed-1").iterdir()
    other = tmp_path / "seed-1" / name.format(world.identity)
    other.touch()
    with pytest.raises(InputError, match=f"{other.name} belongs to another world"):
        TensorBoard(tmp_path).add(world, [row])
    assert {*(tmp_path / "seed-1").iterdir()} == {own, other}


class Clock:
    """A clock that moves on while the program sleeps, and a signal at a certain time."""

    def __init__(self, signal_at: float = 1e9) -> None:
        self.now, self.naps, self.signal_at = 50.0, list[float](), 50.0 + signal_at

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.naps.append(seconds)
        if self.now <= self.signal_at < self.now + seconds:
            signal.raise_signal(signal.SIGINT)
        self.now += seconds


def test_a_look_follows_after_the_given_seconds_and_a_signal_is_noticed_sooner(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[float] = []
    clock = Clock()

    def look() -> Sources:
        looks.append(clock.now)
        return Sources({}, len(looks) < 3)

    monkeypatch.setattr("primordia.tracking.track.time", clock)
    with pytest.raises(InputError, match="the runs has no row of metrics yet"):
        track(look, "the runs", tmp_path, follow=True, every=1.5)
    assert looks == pytest.approx([50, 51.5, 53])
    assert max(clock.naps) <= 0.2
    clock, looks = Clock(signal_at=2.5), []
    monkeypatch.setattr("primordia.tracking.track.time", clock)
    with pytest.raises(KeyboardInterrupt):
        track(look, "the runs", tmp_path, follow=True, every=100)
    assert looks == [50]
    assert 52.5 <= clock.now <= 52.7 + 1e-9


@pytest.mark.parametrize("every", [0, -1, float("nan")])
def test_the_seconds_between_looks_are_above_0(every: float, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=f"seconds above 0, not {every}"):
        track(pytest.fail, "runs", tmp_path, every=every)
