"""What is written for each dashboard: axes, times, and nothing about the machine."""

import errno
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock, patch

import pytest

from primordia.errors import InputError, Trouble
from primordia.tracking import tensorboard
from primordia.tracking.reader import World
from primordia.tracking.tensorboard import TensorBoard
from primordia.tracking.weights_and_biases import SERVICE, WeightsAndBiases
from tests.dashboards import event_rows, events, offline_records


@pytest.mark.slow
def test_a_run_of_wandb_has_ticks_as_its_axis_and_nothing_of_the_machine(tmp_path: Path) -> None:
    board = WeightsAndBiases(tmp_path)
    board.add(World("seed-1", "2" * 16, "g", {"seed": 1}), [{"tick": 10, "living": 3}])
    (opened,) = board._open.values()
    for about in ("machine_info", "meta", "stats"):
        assert getattr(opened.settings, f"x_disable_{about}"), (
            "wandb takes samples only after seconds"
        )
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


def test_events_have_the_time_at_which_they_were_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = iter((1234.5, 2345.5))
    monkeypatch.setattr(tensorboard, "time", SimpleNamespace(time=lambda: next(now)))
    board, world = TensorBoard(tmp_path), World("seed-1", "0" * 16, "g", {})
    board.add(world, [{"tick": 10, "living": 3.0}, {"tick": 20, "living": 4.0}])
    board.add(world, [{"tick": 30, "living": 0.0}])
    found = [(event.wall_time, event.step) for event in events(tmp_path / "seed-1")]
    board.close()  # all rows were in the file already
    assert found == [(1234.5, 10), (1234.5, 20), (2345.5, 30)]
    assert [row["living"] for row in event_rows(tmp_path / "seed-1")] == [3, 4, 0]


@pytest.mark.parametrize(
    ("fault", "says"),
    [
        (OSError(errno.ENOSPC, "No space left on device"), "No space left on device"),
        (OSError("it is closed"), "it is closed"),
    ],
)
def test_events_that_cannot_be_written_are_one_line_with_the_folder_of_the_world(
    fault: OSError, says: str, tmp_path: Path
) -> None:
    board, worlds = TensorBoard(tmp_path), [World(f"a/seed-{n}", f"{n}", "g", {}) for n in (1, 2)]
    board.add(worlds[0], [{"tick": 10, "living": 3.0}])
    with (
        patch.object(board, "_begun", side_effect=fault),
        pytest.raises(Trouble, match=f"^{tmp_path}/a/seed-2 cannot be written: {says}$"),
    ):
        board.add(worlds[1], [{"tick": 10, "living": 4.0}])
    board.close()
    assert [event.step for event in events(tmp_path / "a" / "seed-1")] == [10]


def test_an_error_of_wandb_is_one_line(tmp_path: Path) -> None:
    board = WeightsAndBiases(tmp_path)
    with (
        patch.object(board, "_begun", side_effect=board._wandb.Error(" it is lost\nfor ever")),
        pytest.raises(Trouble, match=f"^{tmp_path} cannot be written by wandb: it is lost$"),
    ):
        board.add(World("seed-1", "3" * 16, "g", {}), [{"tick": 10, "living": 3}])


@pytest.mark.parametrize("alone", [True, False])
def test_the_files_of_all_worlds_are_closed(
    alone: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The service of wandb ends with the runs, unless the program used it before."""
    monkeypatch.setenv(SERVICE, "a service")
    if alone:
        monkeypatch.delenv(SERVICE)
    ours, theirs = TensorBoard(tmp_path), WeightsAndBiases(tmp_path)
    worlds = {str(number): MagicMock() for number in range(3)}
    worlds["2"].close.side_effect = OSError  # all rows are in the file already
    ours._open, theirs._open = dict(worlds), dict(worlds)
    theirs._wandb = MagicMock()
    ours.close()
    theirs.close()
    for each in worlds.values():
        each.close.assert_called_once_with()
        each.finish.assert_called_once_with()
    assert theirs._wandb.teardown.called == alone


@pytest.mark.parametrize("name", ["events.out.tfevents.1", "notes.primordia-{0}", "z"])
def test_only_files_of_the_same_world_are_replaced(name: str, tmp_path: Path) -> None:
    """If the folder has any other file, nothing is removed."""
    world, row = World("seed-1", "1" * 16, "g", {}), {"tick": 10, "living": 3.0}
    for _ in range(2):
        board = TensorBoard(tmp_path)
        board.add(world, [row])
        board.close()
        (own,) = (tmp_path / "seed-1").iterdir()
        for time in (1, 2):
            own.with_name(f"events.out.tfevents.{time}.host.primordia-{world.identity}").touch()
    earlier = {*(tmp_path / "seed-1").iterdir()}
    other = tmp_path / "seed-1" / name.format(world.identity)
    other.touch()
    with pytest.raises(InputError, match=f"{other.name} belongs to another world"):
        TensorBoard(tmp_path).add(world, [row])
    assert {*(tmp_path / "seed-1").iterdir()} == {*earlier, other}
