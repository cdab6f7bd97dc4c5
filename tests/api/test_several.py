"""Several runs, arms and experiments: the functions behind them get all of them, and all arguments."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock, call, patch

import numpy as np
import pytest

import primordia
from primordia import api
from primordia.comparison import comparison
from primordia.errors import InputError
from primordia.organism.organism import Organism
from primordia.runs import opening

RUN, OUT, MORE = Path("RUN"), Path("OUT"), Path("MORE")


def test_all_runs_of_an_arm_are_opened_in_their_order() -> None:
    arm = primordia.Run(RUN, (OUT, MORE))
    for name in ("opened", "only"):
        with patch.object(opening, name) as behind:
            assert getattr(arm, name)() is behind.return_value
        behind.assert_called_once_with([RUN, OUT, MORE])


def test_a_comparison_has_all_runs_of_an_arm_and_all_arms_of_an_experiment() -> None:
    """An experiment is given as an object or by its directory."""
    arms = [MagicMock() for _ in range(4)]
    with (
        patch("primordia.api.is_experiment", lambda path: path == OUT),
        patch.object(api.Experiment, "records", side_effect=[arms[:2], arms[2:]]),
        patch.object(opening, "opened", side_effect=lambda places, *_: places),
        patch.object(comparison, "compare") as compare,
    ):
        primordia.compare(primordia.Run(RUN, (MORE,)), "OUT", api.Experiment(RUN))
    compare.assert_called_once_with([[RUN, MORE], *arms], None, None, None)


@pytest.mark.parametrize("trust", [False, True])
def test_the_code_in_all_directories_is_trusted_only_if_asked(trust: bool) -> None:
    """Trust is for the copy of the code in the run, and for the present version of the code."""
    archives = MagicMock(side_effect=lambda path, edited=False: SimpleNamespace(
        code=lambda: (path, edited)
    ))  # fmt: skip
    with (
        patch("primordia.api.is_experiment", return_value=False),
        patch.object(primordia.Run, "directories", lambda run: (run.path, *run.others)),
        patch("primordia.api.Archive", archives),
        patch("primordia.api.code.trust") as trusted,
    ):
        loaded = primordia.load(["RUN", OUT, "MORE"], trust)
    assert loaded == primordia.Run(RUN, (OUT, MORE))
    both = [call((path, edited)) for path in (RUN, OUT, MORE) for edited in (False, True)]
    assert trusted.call_args_list == (both if trust else [])


def test_several_directories_are_runs_even_if_one_holds_an_experiment() -> None:
    with (
        patch("primordia.api.is_experiment", lambda path: path == OUT),
        patch.object(primordia.Run, "directories", lambda run: ()),
        patch.object(api.Experiment, "directories", lambda run: ()),
    ):
        loaded = [primordia.load(places) for places in (RUN, "OUT", [OUT], [OUT, RUN])]
    assert [type(each) for each in loaded] == [
        primordia.Run, api.Experiment, api.Experiment, primordia.Run,
    ]  # fmt: skip
    with pytest.raises(InputError, match="no run is given"):
        primordia.load([])


def test_the_arms_of_an_experiment_are_runs_in_the_order_of_the_experiment() -> None:
    campaign = SimpleNamespace(arms={"mild": RUN / "mild", "harsh": RUN / "harsh"})
    with patch("primordia.api.experiments.campaign.recorded", return_value=campaign):
        arms = api.Experiment(RUN).arms
    assert list(arms.items()) == [(name, primordia.Run(RUN / name)) for name in ("mild", "harsh")]


@pytest.mark.parametrize("written", [(), (RUN,), (MORE,), (RUN, MORE)])
def test_dashboards_follow_an_arm_while_one_of_its_runs_is_written(written: Any) -> None:
    with (
        patch.object(primordia.Run, "directories", lambda run: (run.path, *run.others)),
        patch("primordia.api.runs.directory.is_written", lambda path: path in written),
    ):
        sources = primordia.Run(RUN, (MORE,)).sources()
    assert sources.runs == {"": (RUN, MORE)}
    assert sources.go_on == bool(written)


@pytest.mark.parametrize("arms", [["mild"], ["mild", "harsh"]])
@pytest.mark.parametrize(
    ("jobs", "go_on"),
    [
        ({"done": 9, "running": 0, "failed": 0, "waiting": 0}, False),
        ({"done": 9, "running": 0, "failed": 2, "waiting": 0}, False),
        ({"done": 9, "running": 1, "failed": 0, "waiting": 0}, True),
        ({"done": 0, "running": 0, "failed": 0, "waiting": 1}, True),
    ],
)
def test_dashboards_follow_an_experiment_while_jobs_run_or_wait(
    jobs: dict[str, int], go_on: bool, arms: list[str]
) -> None:
    """A single arm has no name on a dashboard."""
    paths = {name: (RUN / name / "a", RUN / name / "b") for name in arms}
    campaign = SimpleNamespace(status=lambda: SimpleNamespace(jobs=jobs), runs=lambda: paths)
    with patch("primordia.api.experiments.campaign.recorded", return_value=campaign):
        sources = api.Experiment(RUN).sources()
        directories = api.Experiment(RUN).directories()
    assert sources.runs == (paths if len(arms) > 1 else {"": paths["mild"]})
    assert sources.go_on is go_on
    assert directories == tuple(path for each in paths.values() for path in each)


@pytest.mark.parametrize(("out", "path"), [(None, None), ("OUT", OUT)])
def test_the_page_of_an_experiment_is_written_to_the_given_place(
    out: str | None, path: Path | None
) -> None:
    with (
        patch("primordia.api.experiments.campaign.recorded") as recorded,
        patch("primordia.report.report.report") as report,
    ):
        assert api.Experiment(RUN).report(out) is report.return_value
    report.assert_called_once_with(recorded.return_value, path)


@pytest.mark.parametrize(("left", "gathered"), [([], True), ([5], False)])
def test_results_are_written_when_no_job_of_any_arm_is_left(
    left: list[int], gathered: bool
) -> None:
    """All jobs of the named arm are done already."""
    campaign = MagicMock(path=OUT, left=lambda only=(): [] if only else left)
    with patch("primordia.api.campaigns.begin", return_value=campaign) as begin:
        made = primordia.experiment("file.toml", only=["mild"])
    begin.assert_called_once_with(Path("file.toml"), None)
    assert campaign.gather.called is gathered
    assert made == api.Experiment(OUT)


def test_an_experiment_that_is_stopped_raises_a_keyboard_interrupt() -> None:
    """The failure of a job does not matter then."""
    ending = SimpleNamespace(stopped=True, failed=[SimpleNamespace(job=3, error="full")])
    campaign = MagicMock(path=OUT, left=lambda only=(): [5])
    with (
        patch("primordia.api.campaigns.begin", return_value=campaign) as begin,
        patch("primordia.api.place_for") as place,
        patch("primordia.api.live_all", return_value=ending),
        pytest.raises(KeyboardInterrupt),
    ):
        primordia.experiment(RUN, "OUT")
    begin.assert_called_once_with(RUN, OUT)
    place.assert_called_once_with(OUT, 1, None, None, 60.0, "cpu")


def test_organisms_are_named_by_themselves_or_by_their_birth_number() -> None:
    run = MagicMock(paths=(RUN,), path=RUN)
    ours, far = (MagicMock(spec=Organism, run=run, id=12, world=world) for world in (0, 2))
    with (
        patch.object(opening, "opened", return_value=run),
        patch("primordia.api.runs.evaluate") as evaluate,
        patch("primordia.api.runs.export") as export,
    ):
        primordia.Run(RUN).evaluate([ours, np.int64(7), far], games=3)
        primordia.Run(RUN).export("OUT", far, far)
        primordia.Run(RUN).export("OUT", 7, world=1)
        with pytest.raises(InputError, match="organisms of one world"):
            primordia.Run(RUN).export("OUT", ours, far)
        with pytest.raises(InputError, match="organisms of one world"):
            primordia.Run(RUN).export("OUT", far, world=1)
        for none in (3.0, "3", (3, 1)):
            with pytest.raises(InputError, match="neither an organism nor a birth number"):
                primordia.Run(RUN).evaluate([none])
    evaluate.assert_called_once_with(run, [(12, 0), (7, 0), (12, 2)], games=3)
    assert [each.args for each in export.mock_calls] == [
        (run, OUT, (12, 12), 2),
        (run, OUT, (7,), 1),
    ]
    assert run.lives.row.mock_calls == [call(7, 0), call(7, 1)], "so that an unborn one is refused"


def test_organisms_of_another_run_are_refused() -> None:
    own, other = (MagicMock(paths=(path,), path=path) for path in (RUN, MORE))
    organism = MagicMock(spec=Organism, run=other, id=12, world=0)
    run = primordia.Run(RUN)
    for asked in (run.evaluate, run.ablate):
        with (
            patch.object(opening, "opened", return_value=own),
            pytest.raises(InputError, match="organism 12 is one of MORE, and not of RUN"),
        ):
            asked([organism])
