"""Files of the user and of a run: no command removes or replaces them for another purpose."""

from pathlib import Path

import pytest

from primordia import files
from primordia.errors import InputError
from primordia.experiments import job
from primordia.experiments.campaign import begin
from tests.commands import complains, here
from tests.experiments.meadows import write
from tests.trouble import SMALL, contents


def test_no_file_of_the_user_is_removed_for_a_run(tmp_path: Path) -> None:
    """A folder of the user's may hold files with the names of a run's files."""
    mine = tmp_path / "mine"
    for name in ("code/a.py", "metrics/a.csv", "checkpoints/weights.pt", "config.toml", "lock"):
        (mine / name).parent.mkdir(parents=True, exist_ok=True)
        (mine / name).write_text("mine")
    before = contents(mine)
    for words in ((), ("--resume",)):
        done = here("run", *SMALL, "--ticks", 9, *words, "--out", mine)
        complains(done, 2, f"{mine} exists already and is not a run", "--out")
        assert "primordia resume" not in done.stderr, "that would be no help"
    assert contents(mine) == before


@pytest.mark.parametrize("arm", [False, True])
def test_an_experiment_writes_into_no_folder_behind_a_link(tmp_path: Path, arm: bool) -> None:
    """The link is in place of a run, or of the folder of its arm."""
    mine = tmp_path / "mine"
    (mine / "code").mkdir(parents=True)
    (mine / "code" / "a.py").write_text("mine")
    chosen = begin(write(tmp_path / "experiment"), tmp_path / "out")
    run = chosen.path / chosen.jobs[0].folder
    link = run.parent if arm else run
    link.parent.mkdir(exist_ok=True)
    link.symlink_to(mine)
    error = f"{link} is a symbolic link, not a folder; a run writes only into its own folders"
    assert job.ending_of(chosen.plan, chosen.jobs[0], chosen.path).error == error
    assert [path.name for path in mine.rglob("*")] == ["code", "a.py"]


PLACES = [
    ["bundle", "{run}", "{run}/config.toml"],
    ["bundle", "{run}", "{run}/lock"],
    ["export", "{run}", "{run}/checkpoints/000000/state.npz"],
    ["phylogeny", "{run}", "--out", "{run}/births/000000.parquet"],
    ["relive", "{run}", "3", "--save", "{run}/deaths/000000.parquet"],
    ["plot", "{run}", "--out", "{run}/births"],
    ["report", "{run}", "--out", "{link}/versions.json"],
    ["film", "{run}", "--out", "{run}/metrics/a.mp4"],
    ["track", "{run}", "--tensorboard", "{run}/deaths/a"],
    ["assay", "heredity", "{run}", "--out", "{run}/checkpoints"],
    ["new", "{run}/origin", "--env", "gym:CartPole-v1"],
]


@pytest.mark.parametrize("words", PLACES, ids=lambda words: words[0])
def test_no_output_takes_the_place_of_a_part_of_a_run(
    words: list[str], run: Path, tmp_path: Path
) -> None:
    (tmp_path / "link").symlink_to(run)
    before = contents(run)
    done = here(*(word.format(run=run, link=tmp_path / "link") for word in words))
    complains(done, 2, f"is part of the run {run}; name another path")
    assert contents(run) == before


@pytest.mark.parametrize("name", ["births", "checkpoints"])
def test_a_file_in_place_of_a_folder_of_a_run_is_named(run: Path, name: str) -> None:
    files.remove(run / name)
    (run / name).write_text("mine")
    done = here("resume", run, "--ticks", 9)
    assert done.returncode in (1, 2)
    complains(done, done.returncode, str(run / name))
    assert (run / name).read_text() == "mine"


def test_a_file_is_no_folder_of_a_run(tmp_path: Path) -> None:
    (tmp_path / "births").write_text("mine")
    with pytest.raises(InputError, match="births is not a folder"):
        files.own_folder(tmp_path / "births")
