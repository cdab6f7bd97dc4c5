"""What `experiment` passes to its jobs, its messages at their ends, and its exit status."""

import json
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, call, create_autospec, patch

import pytest

from primordia import interrupts
from primordia.experiments import view
from primordia.experiments.campaign import Campaign
from primordia.experiments.dispatch import Result
from primordia.experiments.plan import Ending
from tests.commands import here

FILE, OUT = Path("a.toml"), Path("OUT")
FAILED = [Ending(3, "failed", "one reason"), Ending(4, "failed", "another")]


def job(number: int) -> Any:
    return SimpleNamespace(number=number, arm="mild")


@pytest.fixture
def chosen() -> Iterator[MagicMock]:
    """Let each file or directory hold an experiment with 1,205 jobs left, 5 of them in named arms."""
    made = create_autospec(Campaign, instance=True)
    made.path, made.plan, made.job = OUT, "the plan", job
    made.left.side_effect = lambda arms=(): (
        [None] * ((0 if made.live_all.called else 5) if arms else 1205)
    )
    made.status.return_value.to_dict.return_value = {"jobs": {"done": 2}}
    with (
        patch("primordia.experiments.campaign.begin", return_value=made) as made.begin,
        patch("primordia.experiments.campaign.planned", return_value=made) as made.planned,
        patch("primordia.experiments.dispatch.place_for") as made.place_for,
        patch("primordia.experiments.dispatch.live_all", return_value=Result()) as made.live_all,
        patch("primordia.experiments.job.ending_of") as made.ending_of,
    ):
        yield made


def test_the_options_reach_the_jobs(chosen: MagicMock) -> None:
    plain = {"checkpoint_every": 60.0, "device": "cpu"}
    assert here("experiment", FILE, "--quiet").returncode == 0
    assert chosen.begin.call_args == call(FILE, None)
    assert chosen.place_for.call_args == call(OUT, 1205, None, None, **plain)
    chosen.live_all.reset_mock()
    ways = ("--jobs", 3, "--ray", "there", "--checkpoint-every", 7, "--device", "gpu")
    with patch.object(view, "watching") as watching:
        done = here("experiment", FILE, "--out", OUT, "--only", "a", "--only", "b", *ways)
    assert done.returncode == 0
    assert chosen.begin.call_args == call(FILE, OUT)
    given = {"checkpoint_every": 7.0, "device": "gpu"}
    assert chosen.place_for.call_args == call(OUT, 5, 3, "there", **given)
    quiet, read = watching.call_args.args
    assert quiet is False
    read()
    assert chosen.status.call_args == call(("a", "b"))
    place, look = chosen.place_for.return_value, watching.return_value.__enter__.return_value
    assert chosen.live_all.call_args.args[:3] == ([None] * 5, place, look)


@pytest.mark.parametrize(
    ("result", "status", "says"),
    [
        (
            Result(stopped=True, failed=FAILED),
            interrupts.STATUS,
            "Stopped and saved. Go on with: primordia experiment OUT",
        ),
        (
            Result(failed=FAILED, elsewhere=7),
            1,
            "2 jobs failed; give the same command to try again",
        ),
        (Result(elsewhere=1200), 0, "1,200 jobs under way in other processes; see --status"),
        (Result(done=5), 0, "1,205 jobs of other arms left to do"),
    ],
)
def test_jobs_that_are_not_done_are_counted(
    result: Result, status: int, says: str, chosen: MagicMock
) -> None:
    """Results are written only when no job is left."""
    chosen.live_all.return_value = result
    done = here("experiment", FILE, "--only", "a", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (status, "", f"primordia: {says}\n")
    chosen.gather.assert_not_called()


@pytest.mark.parametrize("before", [0, 5])
def test_results_are_written_when_no_job_is_left(before: int, chosen: MagicMock) -> None:
    """The results are written again if all jobs were done before."""
    chosen.left.side_effect = [[None] * before, []]
    chosen.gather.return_value = written = [Path("OUT/a.json"), Path("OUT/b.png")]
    done = here("experiment", FILE, "--quiet")
    assert chosen.live_all.call_count == (before > 0)
    assert (done.returncode, done.stdout.split()) == (0, [str(path) for path in written])
    assert done.stderr == ""


def test_a_failed_job_is_named_and_may_be_tried_again(chosen: MagicMock) -> None:
    assert here("experiment", FILE, "--quiet").returncode == 0
    *_, failed = chosen.live_all.call_args.args
    with patch("primordia.cli.experiment.report") as report:
        for again in (True, False):
            failed(job(3), FAILED[0], again)
    says = "job 3 (mild) failed: one reason"
    assert report.mock_calls == [call(f"{says}; the job is tried again"), call(says)]


ENDS: dict[str, tuple[int, str]] = {
    "done": (0, ""),
    "failed": (1, "job 0 (mild) failed: reason"),
    "elsewhere": (2, "job 0 is being run by another process"),
    "stopped": (interrupts.STATUS, "job 0 stopped; the same command goes on with this job"),
}


@pytest.mark.parametrize("state", ENDS)
def test_a_job_alone_ends_with_its_own_status(state: Any, chosen: MagicMock) -> None:
    chosen.ending_of.return_value = Ending(0, state, "reason")
    ways = ("--checkpoint-every", 7, "--device", "gpu")
    done = here("experiment", FILE, "--job", 0, *ways)
    status, says = ENDS[state]
    assert (done.returncode, done.stdout) == (status, "")
    assert done.stderr == (f"primordia: {says}\n" if says else "")
    assert chosen.ending_of.call_args == call("the plan", job(0), OUT, 7.0, "gpu")
    chosen.live_all.assert_not_called()


def test_the_status_is_read_and_nothing_is_begun(chosen: MagicMock) -> None:
    done = here("experiment", FILE, "--out", OUT, "--status", "--json")
    assert json.loads(done.stdout) == {"jobs": {"done": 2}}
    assert chosen.planned.call_args == call(FILE, OUT)
    chosen.begin.assert_not_called()
    chosen.live_all.assert_not_called()


@pytest.mark.parametrize("asked", [(), ("--trust",)])
def test_code_of_an_experiment_is_trusted_only_if_asked(
    asked: tuple[str, ...], chosen: MagicMock
) -> None:
    with patch("primordia.api.load") as load:
        here("experiment", FILE, "--quiet", *asked)
    assert load.call_args_list == ([call(chosen.path, trust=True)] if asked else [])
