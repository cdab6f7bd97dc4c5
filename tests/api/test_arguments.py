"""Each argument of the Python interface reaches the function behind it."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import ANY, MagicMock, call, patch

import numpy as np
import pyarrow as pa
import pytest

import primordia
from primordia import api
from primordia.api import runs
from primordia.comparison import comparison
from primordia.phylogeny import formats

RUN, OUT = Path("RUN"), Path("OUT")
HERE = SimpleNamespace(paths=(RUN,))
"""The run of an organism."""


@pytest.fixture
def opened() -> Iterator[MagicMock]:
    """Replace the records of any run. The row of an organism is 100 times its world plus its number."""
    records = MagicMock(paths=(RUN,), made_on="cpu")
    lives = records.lives
    lives.row = lambda organism, world: 100 * world + organism
    lives.oldest = lambda world=None, after=0.5: 100 * (9 if world is None else world) + 10 * after
    with (
        patch("primordia.api.runs.opening.opened", return_value=records),
        patch("primordia.api.runs.opening.only", return_value=records),
        patch.object(runs, "Organism", lambda run, row: Found(run, row)),
    ):
        yield records


class Found(SimpleNamespace):
    """An organism by its row: 203 is organism 3 of world 2."""

    def __init__(self, run: Any, row: float) -> None:
        super().__init__(run=run, row=row, id=row % 100, world=row // 100)


@pytest.mark.parametrize(
    ("name", "words", "options", "row"),
    [
        ("organism", (3,), {}, 3),
        ("organism", (3, 2), {}, 203),
        ("oldest", (), {}, 905),
        ("oldest", (2,), {}, 205),
        ("oldest", (), {"after": 0.25}, 902.5),
        ("oldest", (2, 0.25), {}, 202.5),
    ],
)
def test_an_organism_is_found_in_its_world(
    name: str, words: tuple[Any, ...], options: dict[str, Any], row: float, opened: MagicMock
) -> None:
    found: Any = getattr(primordia.Run(RUN), name)(*words, **options)
    assert (found.run, found.row) == (opened, row)


def test_the_champions_are_those_of_all_worlds(opened: MagicMock) -> None:
    opened.lives.champions = lambda: np.array([3, 104, 205])
    found: Any = primordia.Run(RUN).champions()
    assert [(each.run, each.row) for each in found] == [(opened, row) for row in (3, 104, 205)]


def test_a_bundle_is_made_of_the_run_that_a_pattern_names(opened: MagicMock) -> None:
    opened.path = RUN
    with patch("primordia.api.runs.bundle.write") as write:
        assert primordia.Run(Path("R*")).bundle("OUT") == OUT
    write.assert_called_once_with(RUN, OUT)


def test_all_columns_of_a_table_are_arrays(opened: MagicMock) -> None:
    """Arrow reads booleans into an array only with a copy."""
    opened.table = {"births": pa.table({"id": [3, 4], "inherited": [True, False]})}.get
    found = primordia.Run(RUN).arrays("births")
    assert {name: values.tolist() for name, values in found.items()} == {
        "id": [3, 4],
        "inherited": [True, False],
    }


CASES: list[tuple[str, tuple[Any, ...], dict[str, Any], str, Any]] = [
    ("evaluate", ([Found(HERE, 203), Found(HERE, 4)],), {"games": 3}, "evaluate",
     call(ANY, [(3, 2), (4, 0)], games=3)),
    ("shadow", (3, 9), {"island": "i"}, "shadow", call(ANY, 3, 9, "i")),
    ("shadow", (), {}, "shadow", call(ANY, 500, None, None)),
    ("heredity", (0.25,), {"island": "i"}, "heredity", call(ANY, 0.25, "i")),
    ("heredity", (), {}, "heredity", call(ANY, 0.5, None)),
    ("threshold", (0.25,), {"island": "i"}, "threshold", call(ANY, 0.25, "i")),
    ("threshold", (), {}, "threshold", call(ANY, 0.5, None)),
    ("islands", (), {}, "on_islands", call(ANY)),
    ("ancestors", (3, 2), {"say": print}, "ancestors", call(ANY, 3, 2, print)),
    ("ancestors", (3,), {"say": print}, "ancestors", call(ANY, 3, 0, print)),
    ("ancestors", (0, 2), {"say": print}, "ancestors", call(ANY, 0, 2, print)),
    ("ancestors", (), {"say": print}, "ancestors", call(ANY, 5, 9, print)),
    ("ancestors", (None, 2), {"say": print}, "ancestors", call(ANY, 5, 2, print)),
    ("lineages", (2, 7), {}, "lines", call(ANY, 2, 7)),
    ("lineages", (), {}, "lines", call(ANY, None, None)),
    ("export", ("OUT", 4, 5), {"world": 2}, "export", call(ANY, OUT, (4, 5), 2)),
    ("export", (OUT,), {}, "export", call(ANY, OUT, (), 0)),
]  # fmt: skip
"""A method, its arguments, the function behind it, and that function's arguments."""


@pytest.mark.parametrize(("name", "words", "options", "behind", "expected"), CASES)
def test_each_argument_of_a_method_reaches_the_function_behind_it(
    name: str, words: Any, options: Any, behind: str, expected: Any, opened: MagicMock
) -> None:
    with patch.object(runs, behind) as function:
        assert getattr(primordia.Run(RUN), name)(*words, **options) is function.return_value
    assert function.call_args == expected
    assert function.call_args.args[0] is opened


PLACES: list[tuple[str, tuple[Any, ...], dict[str, Any], str, Any]] = [
    ("plot", ("OUT", 2, ["deaths"]), {}, "figures.plot.plot", call(ANY, OUT, 2, ["deaths"])),
    ("plot", (), {}, "figures.plot.plot", call(ANY, None, 0, ())),
    ("film", ("OUT", 2), {"by": "ticks"}, "film.film.film", call(ANY, OUT, 2, by="ticks")),
    ("film", (), {}, "film.film.film", call(ANY, None, 0)),
    ("report", ("OUT",), {}, "report.report.report", call(ANY, OUT)),
    ("report", (), {}, "report.report.report", call(ANY, None)),
    ("watch", (0, print), {}, "report.server.watch", call(ANY, 0, print)),
    ("watch", (), {}, "report.server.watch", call(ANY, 8321, print)),
]


@pytest.mark.parametrize(("name", "words", "options", "behind", "expected"), PLACES)
def test_a_picture_has_the_place_the_world_and_the_options_that_are_given(
    name: str, words: Any, options: Any, behind: str, expected: Any, opened: MagicMock
) -> None:
    with patch(f"primordia.{behind}") as function:
        getattr(primordia.Run(RUN), name)(*words, **options)
    assert function.call_args == expected


@pytest.mark.parametrize("out", [None, "OUT.csv"])
def test_a_phylogeny_is_of_the_whole_past_and_of_the_part_that_is_chosen(
    out: str | None, opened: MagicMock
) -> None:
    say = MagicMock()
    with (
        patch.object(runs, "whole_past") as past,
        patch.object(runs, "chosen") as chosen,
        patch.object(runs, "table") as table,
        patch.object(formats, "save") as save,
    ):
        made = primordia.Run(RUN).phylogeny(0, out=out, say=say, world=2, extant=True)
    past.assert_called_once_with(opened, say)
    chosen.assert_called_once_with(past.return_value.whole, 0, world=2, extant=True)
    if out is None:
        assert made is table.return_value
        table.assert_called_once_with(chosen.return_value)
        save.assert_not_called()
    else:
        assert made is None
        save.assert_called_once_with(chosen.return_value, Path(out), say)


def test_a_run_is_verified_on_the_device_and_with_the_listener_that_are_given(
    opened: MagicMock,
) -> None:
    with (
        patch("primordia.api.runs.devices.selected") as selected,
        patch.object(runs, "verify") as verify,
    ):
        assert primordia.Run(RUN).verify("gpu", print) is verify.return_value
    verify.assert_called_once_with(opened, print)
    selected.assert_called_once_with("gpu", "cpu")


def test_dashboards_get_the_folders_and_options_that_are_given() -> None:
    run = primordia.Run(RUN / "one")
    with patch.object(runs, "track") as track:
        run.track("boards", OUT, follow=True, every=7.0)
    track.assert_called_once_with(run.sources, "one", "boards", OUT, follow=True, every=7.0)


def test_standings_are_those_of_both_groups_with_all_options(opened: MagicMock) -> None:
    groups = {name: MagicMock() for name in ("champion", "alive", "best", "founder")}
    one, two, three, four = groups.values()
    with (
        patch.object(runs, "evolved", return_value=[one, two]) as evolved,
        patch.object(runs, "unevolved", return_value=[three, four]) as unevolved,
    ):
        found = primordia.Run(RUN).standings(7, 2, "i", games=3, ticks=9)
    evolved.assert_called_once_with(opened, 2, "i")
    unevolved.assert_called_once_with(opened, 7, 2, "i")
    assert found == [each.evaluate.return_value for each in groups.values()]
    for each in groups.values():
        each.evaluate.assert_called_once_with(games=3, ticks=9)


def test_a_run_goes_on_with_the_limits_and_the_interval_that_are_given(opened: MagicMock) -> None:
    opened.path = RUN
    with (
        patch("primordia.api.runs.bundle.refuse_changes"),
        patch("primordia.api.runs.devices.selected") as selected,
        patch("primordia.api.runs.loop.resume") as resume,
        patch.object(runs, "fork") as fork,
    ):
        own: dict[str, Any] = {"checkpoint_every": 7.0, "listen": print}
        primordia.Run(RUN).resume(inexact=True, device="gpu", ticks=9, until="none", **own)
        resume.assert_called_once_with(RUN, {"ticks": 9, "until": "none"}, inexact=True, **own)
        selected.assert_called_once_with("gpu", "cpu")
        made = primordia.Run(RUN).fork(9, "OUT", {"seed": 3}, device="gpu", hazard=0.5, **own)
        fork.assert_called_once_with(opened, 9, OUT, {"seed": 3, "hazard": 0.5}, print)
        assert resume.call_args == call(OUT, **own)
        assert selected.call_args_list == [call("gpu", "cpu")] * 2
        assert made.path == OUT


@pytest.mark.parametrize(("resume", "begins"), [(False, "start"), (True, "begin_or_resume")])
def test_a_run_begins_with_the_settings_and_keywords_that_are_given(
    resume: bool, begins: str
) -> None:
    with (
        patch(f"primordia.api.loop.{begins}") as live,
        patch("primordia.api.devices.selected") as selected,
    ):
        given: dict[str, Any] = {"checkpoint_every": 7.0, "listen": print}
        settings = {"cells": 8, "seed": 1}
        run = primordia.run(
            "CartPole-survival", "OUT", settings, resume=resume, device="gpu", seed=2, **given
        )
    chosen, place = live.call_args.args
    assert (chosen.cells, chosen.seed, place, run.path) == (8, 2, OUT, OUT)
    assert live.call_args.kwargs == given
    selected.assert_called_once_with("gpu")


def test_a_run_or_a_fork_without_a_directory_gets_a_new_one(
    opened: MagicMock, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("runs", "first-at9").mkdir(parents=True)
    with (
        patch("primordia.api.loop.start") as start,
        patch("primordia.api.runs.loop.resume") as resume,
        patch.object(runs, "fork") as fork,
    ):
        new = Path("runs", "CartPole-survival-seed3")
        assert primordia.run("CartPole-survival", seed=3).path == start.call_args.args[1] == new
        assert start.call_args.kwargs == {"checkpoint_every": 60.0, "listen": None}
        fresh = Path("runs", "first-at9-2")
        assert primordia.Run(Path("else", "first")).fork(9).path == fresh
        assert fork.call_args == call(opened, 9, fresh, {}, None)
        assert resume.call_args == call(fresh, checkpoint_every=60.0, listen=None)


def test_a_new_directory_has_the_first_free_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("a", "a-2", "a-3"):
        assert api.fresh_directory("a") == Path("runs", name)
        Path("runs", name).mkdir(parents=True)
    (tmp_path / "runs" / "a-2").rmdir()
    assert api.fresh_directory("a") == Path("runs", "a-2")


def test_a_directory_is_named_by_the_task_and_the_seed() -> None:
    chosen: Any = SimpleNamespace(task="a/b\nc\x07 é", seed=12)
    assert api.default_name(chosen) == "a-b-c- é-seed12"


def test_a_comparison_has_its_horizons_and_all_arms_in_their_order() -> None:
    one, two = MagicMock(), MagicMock()
    with (
        patch("primordia.api.opening.opened", side_effect=[one, two]) as opened,
        patch.object(comparison, "compare") as compare,
    ):
        primordia.compare("h=runs/h*", Path("b"), births=3, ticks=9)
    compare.assert_called_once_with([one, two], 3, 9, None)
    assert opened.call_args_list == [call(["runs/h*"], "h"), call(["b"], None)]


def test_an_experiment_compares_its_arms_with_the_horizons_that_are_given() -> None:
    arms = [MagicMock(), MagicMock()]
    with (
        patch.object(api.Experiment, "records", return_value=arms),
        patch("primordia.api.experiments.compare") as compare,
    ):
        api.Experiment(RUN).compare(3, 9, "i")
    compare.assert_called_once_with(arms, 3, 9, "i")


def test_an_experiment_draws_the_world_and_figures_of_each_arm() -> None:
    arms = {"b": MagicMock(), "a": MagicMock()}
    for name, arm in arms.items():
        arm.plot.return_value = [Path(name)]
    with (
        patch.object(api.Experiment, "arms", arms),
        patch.object(api.Experiment, "compare"),
        patch("primordia.figures.comparison.save", return_value=[Path("compare")]) as save,
    ):
        drawn = api.Experiment(RUN).plot("OUT", 2, ["deaths"])
        assert drawn == [Path("compare"), Path("b"), Path("a")]
        assert save.call_args.args[1] == OUT
        for name, arm in arms.items():
            arm.plot.assert_called_once_with(OUT / name, 2, ["deaths"])
        api.Experiment(RUN).plot()
        assert save.call_args.args[1] == RUN / "figures"
