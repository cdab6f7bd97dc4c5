"""Food gathered over time: from the metrics, and in figures."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

import primordia
from primordia.figures import foraging as figure
from primordia.figures import style
from primordia.history import foraging as module
from primordia.history.foraging import Harvest, foraging
from primordia.law.metabolism import ONE
from primordia.runs import loop
from primordia.runs.archive import Archive
from primordia.settings.islands import Islands
from tests.history.larders import FED, FOOD, RICH
from tests.worlds import config


@pytest.fixture(scope="module")
def fed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Make a run with the same food for all, which is worth more from tick 200 on."""
    run = tmp_path_factory.mktemp("foraging") / "fed"
    loop.start(config(FED, stop={"ticks": 400}), run)
    return run


def test_all_gather_the_food_there_is_and_seasons_move_the_break_even(fed: Path) -> None:
    gathered = foraging(Archive(fed))
    assert gathered.food.shape == gathered.break_even.shape == (2, len(gathered.middle))
    assert len(gathered.middle) >= 400 // FED["sample_every"]
    np.testing.assert_allclose(gathered.food, FOOD)
    expected = np.where(gathered.middle <= RICH, 1, 1 / 4)
    np.testing.assert_allclose(gathered.break_even, [expected] * 2)


AMOUNTS = st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=1, max_size=30)


@given(AMOUNTS, st.lists(st.integers(0, 30), min_size=2, max_size=6, unique=True))
def test_food_between_samples_is_the_food_gathered_over_the_ticks_lived(
    amounts: list[tuple[int, int]], edges: list[int]
) -> None:
    """There is a sample for each tick; nothing is known after the last one."""
    food, lived = np.array(amounts, float).T
    totals = (np.append(0, np.cumsum(each)) for each in (food, lived))
    harvest = Harvest(np.arange(len(food) + 1), *totals)
    for first, last, rate in zip(
        sorted(edges), sorted(edges)[1:], harvest.between(np.sort(edges)), strict=False
    ):
        ticks = lived[first:last].sum()
        expected = food[first:last].sum() / ticks if ticks else np.nan
        np.testing.assert_allclose(rate, expected)


def test_the_figure_of_a_fork_that_has_not_lived_says_so(fed: Path, tmp_path: Path) -> None:
    forked = primordia.load(fed).fork(30, tmp_path / "fork", stop={"ticks": 30})
    with style.applied():
        drawn = figure.draw(Archive(forked.path), 0)
        drawn.draw_without_rendering()
    assert "no samples yet" in {text.get_text() for text in drawn.axes[0].texts}


@pytest.mark.parametrize("begun", [0, 30])
def test_worlds_of_unequal_length_share_their_intervals(begun: int) -> None:
    """Two worlds of a run, or of a fork, have different food, and seasons change their climates."""
    ends, every, gains = (begun + 40, begun + 60), 10, ((2.0, 4.0), (0.5, 1.0))
    food, change = ((3, 1), (5, 2)), begun + 20
    earlier = 100 if begun else 0
    rows, totals = [], np.full((2, 2), earlier)
    for world, end in enumerate(ends):
        for tick in range(begun + 1, end + 1):
            totals[world] += food[world][tick > change], 2
            if tick % every == 0:
                rows.append((world, tick, *totals[world], 1.5, gains[world][tick >= change]))
    names = ("world", "tick", "food", "organism_ticks", "metabolism.drain", "metabolism.gain")
    now = {"tick": np.array(ends), "food": totals[:, 0] * ONE, "organism_ticks": totals[:, 1]}
    before = {"tick.lo": begun, "food.lo": earlier * ONE, "organism_ticks.lo": earlier}
    climate = {"metabolism.drain": [1.5, 1.5], "metabolism.gain": [gains[0][0], gains[1][0]]}
    origin = {f"world.worlds.{k}": np.full(2, v, np.uint32) for k, v in before.items()}
    origin |= {f"world.worlds.{name[:-3]}.hi": np.zeros(2, np.uint32) for name in before}
    origin |= {f"world.worlds.climate.{k}": np.array(v, np.float32) for k, v in climate.items()}
    start = {"metabolism.drain": 1.5, "metabolism.gain": gains[0][0]}
    run: Any = SimpleNamespace(
        config=SimpleNamespace(seeds=2, seasons=["any"], islands=Islands(("",), (0, 9))),
        description=SimpleNamespace(beginning=start),
        metrics=pa.table(dict(zip(names, map(np.array, zip(*rows, strict=True)), strict=True))),
        origin=origin if begun else None,
        count=lambda name: now[name.removeprefix("world.worlds.")],
    )
    found = foraging(run)
    assert found.first_tick == begun
    np.testing.assert_allclose(found.middle, begun + np.array([5, 15, 25, 35, 45, 55]))
    unknown = np.nan
    expected = [[1.5, 1.5, 0.5, 0.5, unknown, unknown], [2.5, 2.5, 1, 1, 1, 1]]
    np.testing.assert_allclose(found.food, expected)
    first = gains[1][0] if begun else gains[0][0]
    gained = [[2, 2, 4, 4, 4, 4], [first, gains[1][0], 1, 1, 1, 1]]
    np.testing.assert_allclose(found.break_even, 1.5 / np.array(gained))


def test_a_long_run_has_60_intervals(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = np.arange(0.0, 6_001, 10)
    monkeypatch.setattr(module, "harvests", lambda run, worlds: [Harvest(ticks, ticks, ticks)])
    run: Any = SimpleNamespace(
        config=SimpleNamespace(seeds=1, seasons=[], islands=Islands(("",), (0, 9))),
        description=SimpleNamespace(beginning={"metabolism.drain": 1.0, "metabolism.gain": 1.0}),
        origin=None,
    )
    np.testing.assert_allclose(foraging(run).middle, np.arange(50, 6_000, 100))


class Seasons:
    """A past in which the drain is the tick, and the gain is 2. World 1 has no drain, world 2 no gain."""

    def __init__(self, run: Any) -> None: ...

    def of_worlds(self, worlds: np.ndarray, ticks: np.ndarray) -> dict[str, np.ndarray]:
        drain, gain = np.where(worlds == 1, 0, ticks), np.where(worlds == 2, 0.0, 2.0)
        return {"metabolism.drain": drain, "metabolism.gain": gain}


@pytest.mark.parametrize("order", [(0, 1, 2), (1, 2, 0)])
def test_the_intervals_are_those_of_the_longest_world_in_any_order(
    order: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The longest world has the fewest samples. The break-even is that of the middle of an interval."""
    every = [np.arange(0.0, end + 1, step) for end, step in ((60, 20), (40, 10), (30, 5))]
    monkeypatch.setattr(
        module, "harvests", lambda run, worlds: [Harvest(*[every[k]] * 3) for k in order]
    )
    monkeypatch.setattr(module, "PastClimate", Seasons)
    found = foraging(SimpleNamespace(config=SimpleNamespace(seeds=3)))
    middle = np.arange(5.0, 60, 10)
    np.testing.assert_allclose(found.middle, middle)
    expected = [middle / 2, np.zeros(6), np.full(6, np.inf)]
    np.testing.assert_array_equal(found.break_even, expected)


def test_food_of_intervals_shorter_than_a_tick_is_that_of_the_tick() -> None:
    """A comparison of a run of six ticks has intervals of half a tick."""
    harvest = Harvest(*np.array([[0.0, 1, 2], [0, 0.25, 0.75], [0, 1, 2]]))
    np.testing.assert_allclose(harvest.between(np.arange(5) / 2), [0.25, 0.25, 0.5, 0.5])
