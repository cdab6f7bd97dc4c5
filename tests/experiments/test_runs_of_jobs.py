"""A job begins, forks or resumes a run, with the settings and options of the experiment."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import ANY, MagicMock

import pytest

from primordia.config import Config
from primordia.errors import InputError, InUseError
from primordia.experiments import job as jobs
from primordia.experiments.campaign import Campaign, begin
from primordia.experiments.ledger import Ledger
from tests.experiments.meadows import write

CLEAR = "primordia.experiments.job.directory.clear_unbegun"
HELD = {"a 1", "b 2"}
"""Files of code that a run holds, each with a mark of its content."""


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> MagicMock:
    """Let jobs run nothing; return a log of their calls that begin, fork or resume a run."""
    log = MagicMock()
    for name in ("loop.start", "loop.resume", "fork", "Archive", "code.trust", "code.found"):
        monkeypatch.setattr(f"primordia.experiments.job.{name}", getattr(log, name.split(".")[-1]))
    monkeypatch.setattr(jobs, "Code", lambda files: SimpleNamespace(marks=HELD))
    monkeypatch.setattr(jobs, "info", lambda run: {"worlds": []})
    log.found.return_value.marks = HELD
    return log


@pytest.fixture
def chosen(tmp_path: Path) -> Campaign:
    return begin(write(tmp_path), tmp_path / "runs" / "mills")


@pytest.fixture
def forked(chosen: Campaign, tmp_path: Path) -> Campaign:
    fork = {"fork": {"of": "mills/mild", "at": 150}, "task": None, "seeds": None}
    return begin(write(tmp_path, "two", **fork), tmp_path / "runs" / "two")


def live(campaign: Campaign, number: int) -> tuple[Path, Config]:
    """Run a job -> its directory and its configuration."""
    job = campaign.jobs[number]
    jobs.live(campaign.plan, job, campaign.path, 7.0)
    return campaign.path / job.folder, jobs.configuration(campaign.plan, job)


@pytest.mark.parametrize("begun", [True, False])
def test_a_fork_is_made_once_and_goes_on(
    begun: bool, forked: Campaign, calls: MagicMock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(CLEAR, lambda run: not begun)
    calls.Archive.return_value.config.on_copies = dict
    run, config = live(forked, 2)
    assert not calls.start.called
    limits = config.stop.model_dump()
    calls.resume.assert_called_once_with(run, limits, checkpoint_every=7.0, listen=ANY)
    assert limits["ticks"] == 300
    if begun:
        assert not calls.fork.called
        return
    source, tick, made, changes, _ = calls.fork.call_args[0]
    assert (source, tick, made) == (calls.Archive(), 150, run)
    assert calls.Archive.call_args_list[0][0] == (forked.path.parent / "mills" / "mild" / "0-1",)
    own = {"task", "about", "fork", "seeds", "ancestors"}
    assert {*changes} == {*Config.model_fields} - own
    assert (changes["seed"], changes["hazard"]) == (config.seed, config.hazard) == (3, 0.05)


@pytest.mark.parametrize(("written", "raised"), [(True, InUseError), (False, InputError)])
def test_a_fork_that_another_command_begins_meanwhile_is_left_to_it(
    written: bool,
    raised: type[InputError],
    forked: Campaign,
    calls: MagicMock,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """If the other command has ended, the job goes on; any other error is the job's."""
    calls.fork.side_effect = InputError("exists already")
    calls.Archive.return_value.config.on_copies = dict
    monkeypatch.setattr("primordia.experiments.job.directory.is_written", lambda run: written)
    monkeypatch.setattr(CLEAR, lambda run: True)
    with pytest.raises(raised):
        live(forked, 2)
    assert not calls.resume.called
    free = iter([True, False])
    monkeypatch.setattr("primordia.experiments.job.directory.is_written", lambda run: False)
    monkeypatch.setattr(CLEAR, lambda run: next(free))
    live(forked, 2)
    calls.resume.assert_called_once()


@pytest.mark.parametrize(
    ("here", "trusted"),
    [({"a 1", "b 2", "c 3"}, True), ({"a 1", "b 3"}, False)],
)
def test_only_code_that_the_user_has_here_is_trusted(
    here: set[str], trusted: bool, chosen: Campaign, calls: MagicMock,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    """Each file that the run holds must be here, with the same content."""
    monkeypatch.setattr(CLEAR, lambda run: False)
    calls.found.return_value.marks = here
    run, config = live(chosen, 0)
    assert calls.trust.called == trusted
    calls.resume.assert_called_once_with(
        run, config.stop.model_dump(), checkpoint_every=7.0, listen=ANY
    )


def test_a_new_run_has_the_settings_of_its_arm_and_runs_on_the_device_that_is_given(
    chosen: Campaign, calls: MagicMock, monkeypatch: pytest.MonkeyPatch
) -> None:
    selected: list[str] = []

    @contextmanager
    def select(name: str) -> Iterator[None]:
        selected.append(name)
        yield
        selected.append("none")

    def start(*_: Any, **options: Any) -> None:
        assert Ledger(chosen.path, [job]).entry(job).state == "running"
        selected.append("started")
        (chosen.path / job.folder).mkdir(parents=True)

    job, calls.start.side_effect = chosen.jobs[3], start
    monkeypatch.setattr("primordia.experiments.job.devices.selected", select)
    jobs.live(chosen.plan, job, chosen.path, 7.0, "gpu")
    assert selected == ["gpu", "started", "none"]
    assert chosen.status().jobs["done"] == 1
    config = jobs.configuration(chosen.plan, job)
    assert (config.seed, config.seeds, config.hazard) == (5, 1, 0.05)
    run = chosen.path / job.folder
    calls.start.assert_called_once_with(config, run, checkpoint_every=7.0, listen=ANY)
    assert not calls.resume.called
