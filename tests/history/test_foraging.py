"""What organisms gather as time goes on: from the metrics, in figures, and from run to run."""

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import primordia
from primordia.figures import foraging as figure
from primordia.figures import style
from primordia.history.foraging import Harvest, foraging
from primordia.runs import loop
from primordia.runs.archive import Archive
from tests.commands import here
from tests.worlds import MEADOW, config

FOOD = 0.25
FED: dict[str, Any] = {
    **MEADOW,
    "habitat": {"name": "tests.toys:Meadow", "lifespan": 60, "food": FOOD},
    "metabolism": {"store": 30.0, "drain": 1.0, "gain": 2.0},
    "seasons": [{"kind": "schedule", "setting": "metabolism.gain", "at": 200, "value": 8.0}],
    "brain": {"hidden": 1},
    "seeds": 2,
    "replication": 0.1,
    "sample_every": 40,
    "stop": {"ticks": 400, "until": "none"},
}


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Worlds in which all find the same, from tick 200 on more than they need; less; and nothing."""
    folder = tmp_path_factory.mktemp("foraging")
    less = {**FED, "habitat": {**FED["habitat"], "food": FOOD / 2}}
    none = {name: value for name, value in FED.items() if name not in ("metabolism", "seasons")}
    none["habitat"] = {**FED["habitat"], "food": 0.0}
    for name, settings in {"fed": FED, "less": less, "none": none}.items():
        loop.start(config(settings), folder / name)
    return {name: folder / name for name in ("fed", "less", "none")}


def test_all_find_what_there_is_and_seasons_move_the_break_even(runs: dict[str, Path]) -> None:
    found = foraging(Archive(runs["fed"]))
    assert found.food.shape == found.break_even.shape == (2, len(found.middle))
    assert len(found.middle) >= 400 // FED["sample_every"]
    np.testing.assert_allclose(found.food, FOOD)
    expected = np.where(found.middle <= 200, 1 / 2, 1 / 8)
    np.testing.assert_allclose(found.break_even, [expected] * 2)


AMOUNTS = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=1, max_size=30)


@given(AMOUNTS, st.lists(st.integers(0, 30), min_size=2, max_size=6, unique=True))
def test_between_samples_is_what_was_gathered_by_what_was_lived(
    amounts: list[tuple[int, int]], edges: list[int]
) -> None:
    """A sample a tick; after the last one nothing is known."""
    food, lived = np.array(amounts, float).T
    totals = (np.append(0, np.cumsum(each)) for each in (food, lived))
    harvest = Harvest(np.arange(len(food) + 1), *totals)
    for first, last, found in zip(
        sorted(edges), sorted(edges)[1:], harvest.between(np.sort(edges)), strict=False
    ):
        ticks = lived[first:last].sum()
        expected = food[first:last].sum() / ticks if ticks else np.nan
        np.testing.assert_allclose(found, expected)


def test_the_figure_is_of_foragers_only(runs: dict[str, Path], tmp_path: Path) -> None:
    for name, drawn in (("fed", True), ("none", False)):
        files = [path.name for path in primordia.Run(runs[name]).plot(tmp_path / name)]
        assert ("foraging.png" in files, "foraging.svg" in files) == (drawn, drawn)
    said = (tmp_path / "fed" / "foraging.svg").read_text(encoding="utf-8")
    for words in ("in a tick", "median and quartiles of 2 worlds", "break-even", "time (ticks)"):
        assert words in said


def test_a_run_too_short_for_a_sample_has_a_figure_that_says_so(tmp_path: Path) -> None:
    loop.start(config(FED, stop={"ticks": 30}), tmp_path / "run")
    with style.look():
        drawn = figure.draw(Archive(tmp_path / "run"))
        drawn.draw_without_rendering()
    assert "no samples yet" in {text.get_text() for text in drawn.axes[0].texts}


def test_what_nobody_can_live_on_has_no_break_even(tmp_path: Path) -> None:
    hungry = {"metabolism": {"store": 30.0, "gain": 0.0}, "seasons": []}
    loop.start(config(FED, **hungry), tmp_path / "run")
    assert np.isinf(foraging(Archive(tmp_path / "run")).break_even).all()
    with style.look():
        drawn = figure.draw(Archive(tmp_path / "run"))
        drawn.draw_without_rendering()
    assert "break-even" not in {text.get_text() for text in drawn.axes[0].texts}


def test_runs_are_compared_by_it_where_there_is_food(runs: dict[str, Path], tmp_path: Path) -> None:
    found = primordia.compare(runs["fed"], runs["less"])
    assert found.outcomes["food"] == "food a tick, late"
    values = [arm.figures["food"].value.tolist() for arm in found.arms]
    np.testing.assert_allclose(values, [[FOOD] * 2, [FOOD / 2] * 2])
    against = found.contrast(found.arms[1], "food")
    assert (against.delta, against.ratio) == (-1, (0.5, 0.5))
    again = Path(shutil.copytree(runs["none"], tmp_path / "again"))
    assert "food" not in primordia.compare(runs["none"], again).outcomes
    np.testing.assert_allclose([arm.gathering.curve.mean() for arm in found.arms], [FOOD, FOOD / 2])
    told = here("compare", runs["fed"], runs["less"], "--out", tmp_path)
    assert "large less" in told.stdout
    assert "Food gathered in a tick" in (tmp_path / "compare.svg").read_text(encoding="utf-8")
