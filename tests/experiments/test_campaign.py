"""An experiment in its directory: the runs of each arm, and the jobs that are left."""

from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest

import primordia
from primordia.errors import InputError
from primordia.experiments import campaign
from primordia.experiments.campaign import Campaign, begin
from primordia.experiments.file import read
from primordia.experiments.ledger import Entry, Ledger
from tests.experiments.meadows import write


@pytest.fixture
def chosen(tmp_path: Path) -> Campaign:
    """Return an experiment of the jobs mild/0-1, mild/2, harsh/0-1 and harsh/2."""
    return begin(write(tmp_path), tmp_path / "out")


def end(chosen: Campaign, *numbers: int, state: Any = "done") -> None:
    """End some jobs, each with a run that has a checkpoint."""
    for number in numbers:
        job = chosen.jobs[number]
        run = chosen.path / job.folder
        (run / "checkpoints" / "000001").mkdir(parents=True)
        (run / "checkpoints" / "000001" / "manifest.json").touch()
        Ledger(chosen.path, [job]).write(job, Entry(job=number, arm=job.arm, state=state))


def test_runs_are_those_of_each_arm_that_have_a_checkpoint(chosen: Campaign) -> None:
    """The arms are in the order of the file, not of the alphabet."""
    (chosen.path / "mild" / "0-1").mkdir(parents=True)
    end(chosen, 2, 1)
    out = chosen.path
    runs = {"mild": [out / "mild" / "2"], "harsh": [out / "harsh" / "0-1"]}
    assert chosen.runs() == runs
    assert list(chosen.runs()) == ["mild", "harsh"]
    assert primordia.load(out).directories() == (out / "mild" / "2", out / "harsh" / "0-1")
    end(chosen, 3)
    assert chosen.runs()["harsh"] == [out / "harsh" / "0-1", out / "harsh" / "2"]


def test_jobs_that_are_left_are_those_not_done(chosen: Campaign) -> None:
    end(chosen, 0, 3)
    end(chosen, 1, state="failed")
    assert [job.number for job in chosen.left()] == [2, 1]
    assert [job.number for job in chosen.left(["mild"])] == [1]
    assert [job.number for job in chosen.left(["harsh", "mild"])] == [2, 1]
    assert chosen.status(["mild"]).jobs == {"done": 1, "running": 0, "failed": 1, "waiting": 0}
    assert chosen.status(["harsh", "mild"]) == chosen.status()
    assert [chosen.job(number).number for number in range(4)] == [0, 1, 2, 3]
    for number in (-1, 4):
        with pytest.raises(InputError, match=f"has no job {number}; the jobs are 0 to 3$"):
            chosen.job(number)


def test_info_has_for_each_arm_its_own_settings_and_worlds(chosen: Campaign) -> None:
    """Settings that all arms share are left out. An arm that has not begun has no worlds."""
    end(chosen, 1)
    worlds = {chosen.path / "harsh": [{"seed": 3}, {"seed": 4}]}

    def opened(places: list[Path]) -> Path:
        if places[0] not in worlds:
            raise InputError("not a run")
        return places[0]

    with (
        patch.object(campaign, "opened", opened),
        patch.object(campaign, "info", lambda folder: {"worlds": worlds[folder]}),
    ):
        found = chosen.info()
    assert found == {
        "question": "Is it mild?",
        "jobs": {"done": 1, "running": 0, "failed": 0, "waiting": 3},
        "arms": [
            {"name": "mild", "settings": {"hazard": 0.01}, "worlds": []},
            {"name": "harsh", "settings": {"hazard": 0.05}, "worlds": [{"seed": 3}, {"seed": 4}]},
        ],
    }


def test_results_are_those_of_all_arms_in_their_order(chosen: Campaign) -> None:
    for name in chosen.arms:
        (chosen.path / name).mkdir()
    with (
        patch.object(campaign, "opened", lambda places: places),
        patch("primordia.experiments.results.write") as asked,
    ):
        assert chosen.gather() is asked.return_value
    out = chosen.path
    asked.assert_called_once_with(out / "results", "Is it mild?", [[out / "mild"], [out / "harsh"]])


def test_a_directory_has_the_name_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = write(Path("files"), "mill.v2")
    assert campaign.planned(file).path == Path("runs", "mill.v2")
    begun = begin(file)
    assert begin(begun.path, Path("other")).path == begun.path
    assert not Path("other").exists()


def test_genomes_of_ancestors_are_found_from_any_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A job may run elsewhere than the command that began the experiment."""
    monkeypatch.chdir(tmp_path)
    file = write(Path("files"), ancestors=["a.safetensors"])
    (tmp_path / "files" / "a.safetensors").touch()
    with patch("primordia.config.genomes.read", return_value=None):
        arms = read(file, Path("out")).arms
        expected = (str(tmp_path / "files" / "a.safetensors"),)
        assert [arm.config.ancestors for arm in arms] == [expected] * 2
        own = [{"name": "a"}, {"name": "b", "ancestors": ["a.safetensors"]}]
        arms = read(write(Path("files"), arms=own), Path("out")).arms
        assert [arm.config.ancestors for arm in arms] == [(), expected]
