"""The panels of a page, compared with counts over the lives of two worlds of unequal length."""

from collections.abc import Iterator
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.figures import style
from primordia.figures.population import COLOURS
from primordia.history import series
from primordia.history.foraging import Foraging
from primordia.law.world import Cause
from primordia.report import curves
from primordia.report.curves import Panel
from primordia.runs.lives import ALIVE, Lives, joined
from tests.report.conftest import TORUS
from tests.synthetic import alive, surviving, world_of
from tests.worlds import config

LONG = [(tick, tick % 13 + tick // 4, tick % 5 > 0) for tick in range(1, 150, 2)]
SHORT = [(tick, 2 * tick % 9, tick % 3 > 0) for tick in range(0, 80, 2)]
ENDS = 200, 90


def unequal() -> Lives:
    """Return the lives of two worlds, with deaths of two causes. Both have organisms that are alive."""
    lives = joined(
        [world_of(lived, until) for lived, until in zip((LONG, SHORT), ENDS, strict=True)],
        np.array([0, 1]),
    )
    lives.cause[(lives.cause != ALIVE) & (lives.id % 3 == 0)] = Cause.HAZARD
    return lives


def named(lives: Lives, **more: Any) -> dict[str, Panel]:
    """Return the panels by title; `more` changes what the run is."""
    parts = {
        "lives": lives,
        "config": config(TORUS, seeds=lives.worlds, metabolism=None),
        "metrics": pa.table({}),
        "description": SimpleNamespace(rate=None, tallies=()),
    }
    run: Any = SimpleNamespace(**{**parts, **more})
    return {panel["title"]: panel for panel in curves.panels(run)}


def close(values: list[float | None], expected: list[float]) -> bool:
    """Return whether values, with None for NaN, equal others to the digits of a page."""
    got = np.array([np.nan if value is None else value for value in values])
    return np.allclose(got, expected, rtol=1e-4, equal_nan=True)


def test_rates_are_the_events_of_all_worlds_per_tick_of_a_world_that_still_runs() -> None:
    lives, edges = unequal(), series.bins(ENDS[0])
    panel = named(lives)["Births and deaths"]
    assert (panel["x"], panel["y"]) == ("time (ticks)", "per tick of a world")
    (table,) = panel["tables"]
    bins = list(zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True))
    assert close(table["x"], [((low + 1) * high) ** 0.5 for low, high in bins])

    def rates(at: list[int]) -> Iterator[float]:
        for low, high in bins:
            lived = sum(max(min(high, end) - low, 0) for end in ENDS)
            events = sum(low < tick <= high for tick in at)
            yield events / lived if events >= series.MIN_EVENTS else np.nan

    dead = {
        cause: [int(end) for end, why in zip(lives.ended, lives.cause, strict=True) if why == cause]
        for cause in (Cause.FATAL, Cause.HAZARD)
    }
    shown = [("births", style.INK, lives.born.tolist())]
    shown += [(f"deaths: {cause.label}", COLOURS[cause], at) for cause, at in dead.items()]
    for curve, (name, colour, at) in zip(table["curves"], shown, strict=True):
        assert (curve["name"], curve["colour"], curve["kind"]) == (name, colour, "line")
        assert close(curve["values"], list(rates(at)))
    one = named(lives.of_world(0))["Births and deaths"]
    assert one["y"] == "per tick"


def test_population_and_mean_age_of_a_world_end_with_its_last_tick() -> None:
    """After the end of the shorter world half of the worlds have a value: that of the longer one."""
    lives = unequal()
    panels = named(lives)
    limit, living = panels["Organisms alive"]["tables"]
    (ages,) = panels["Mean age of the living"]["tables"]
    assert [(each["name"], each["kind"]) for each in limit["curves"]] == [("all 24 cells", "limit")]
    assert set(limit["curves"][0]["values"]) == {24}
    assert (limit["x"][0], limit["x"][-1]) == (1, ENDS[0])
    for table, name in ((living, "alive"), (ages, "mean age")):
        assert table["x"] == limit["x"]
        *worlds, high, low, middle = table["curves"]
        kinds = [each["kind"] for each in (*worlds, high, low, middle)]
        assert kinds == ["faint", "faint", "high", "low", "line"]
        assert middle["name"] == f"{name}, median and quartiles of 2 worlds"
        assert {each["colour"] for each in table["curves"]} == {style.BLUE}
        for number, curve in enumerate(worlds):
            here, expected = lives.of_world(number), []
            for tick in table["x"]:
                since = [
                    tick - here.born[row] for row in range(len(here)) if alive(here, row, tick)
                ]
                value = len(since) if name == "alive" else np.mean(since) if any(since) else np.nan
                expected.append(value if tick <= ENDS[number] else np.nan)
            assert close(curve["values"], expected)
        after = [i for i, tick in enumerate(table["x"]) if tick > ENDS[1]]
        for each in (high, low, middle):
            assert [each["values"][i] for i in after] == [worlds[0]["values"][i] for i in after]


def test_a_mean_age_below_one_tick_is_shown_and_an_age_of_zero_is_not() -> None:
    """At tick 2 one of the two organisms is newborn, and the other is a tick old."""
    world = world_of([(1, 0, False), (2, 0, False)], until=4)
    (table,) = named(world)["Mean age of the living"]["tables"]
    assert (table["x"], table["curves"][0]["values"]) == ([1, 2, 3, 4], [None, 0.5, 1.5, 2.5])


@pytest.mark.parametrize("births", [1, 2, 3, 4, 5])
def test_each_quarter_with_a_birth_has_a_curve(births: int) -> None:
    """Birth n of N is in quarter 4 n / N, rounded down."""
    world = world_of([(tick, 3, True) for tick in range(births)])
    quarters = ["first", "second", "third", "last"]
    names = {f"{quarters[4 * n // births]} quarter of the births" for n in range(births)}
    tables = named(world)["Alive at each age"]["tables"]
    assert {table["curves"][0]["name"] for table in tables} == names


def test_survival_of_each_quarter_is_the_product_of_the_shares_that_survive() -> None:
    lives = unequal()
    panel = named(lives)["Alive at each age"]
    colours = ["#d89000", "#cc4f39", "#8f2d75", "#2a2f86"]
    births = [int((lives.world == world).sum()) for world in range(2)]
    quarter = [
        4 * rank // births[world] for rank, world in zip(lives.rank, lives.world, strict=True)
    ]
    names = "first quarter", "second quarter", "third quarter", "last quarter"
    for number, (name, table) in enumerate(zip(names, panel["tables"], strict=True)):
        (curve,) = table["curves"]
        assert (curve["name"], curve["kind"]) == (f"{name} of the births", "steps")
        assert curve["colour"] == colours[number]
        shares = surviving(lives.take(np.equal(quarter, number)), int(lives.lifespan.max()))
        assert table["x"][-1] == lives.lifespan.max()
        assert close(curve["values"], [shares[age] for age in table["x"]])
        assert {*shares} - {1.0} <= {shares[age] for age in table["x"]}, "each step is drawn"


def test_quartiles_of_ages_at_death_are_those_of_the_dead_alone() -> None:
    """60 of 90 organisms are dead, and make two bins of 30. A life of one tick lies on the axis."""
    world = world_of([(tick, tick * tick % 61, tick % 3 > 0) for tick in range(90)], until=200)
    dead, living, spread = named(world)["Age at death"]["tables"]
    for table, name, colour in ((dead, "dead", style.SKY), (living, "alive", style.ORANGE)):
        (curve,) = table["curves"]
        assert (curve["name"], curve["colour"], curve["kind"]) == (name, colour, "dots")
    numbers = [tick + 1 for tick in range(90) if tick % 3]
    ages = [(number - 1) ** 2 % 61 + 1 for number in numbers]
    halves = [(numbers[:30], ages[:30]), (numbers[30:], ages[30:])]
    assert spread["x"] == [sum(half) / 30 for half, _ in halves]
    expected = [("", "high", 75), ("", "low", 25), ("median age at death", "line", 50)]
    for curve, (name, kind, share) in zip(spread["curves"], expected, strict=True):
        assert (curve["name"], curve["kind"], curve["colour"]) == (name, kind, style.BLUE)
        assert close(curve["values"], [float(np.percentile(half, share)) for _, half in halves])


def test_without_deaths_only_the_ages_of_the_living_are_shown() -> None:
    (table,) = named(world_of([(0, 0, False)], until=50))["Age at death"]["tables"]
    assert (table["x"], table["curves"][0]["values"]) == ([1], [50])


def test_of_many_lives_evenly_spaced_ones_have_a_dot(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(curves, "DOTS", 5)
    world = world_of([(tick, 7, tick < 9) for tick in range(13)])
    dead, living, _ = named(world)["Age at death"]["tables"]
    assert dead["x"] == [1, 3, 5, 7, 9]
    assert living["x"] == [10, 11, 12, 13]


def test_the_panels_of_a_fork_count_from_the_fork() -> None:
    """Organisms born before tick 50 are on record if they were alive then. Their births do not count."""
    world = world_of([(tick, 40, tick < 155) for tick in range(0, 180, 3)], until=200)
    panels = named(world.recorded_since(50))
    for title in ("Organisms alive", "Mean age of the living", "Births and deaths"):
        assert panels[title]["x"] == "time since the fork (ticks)"
    limit, living = panels["Organisms alive"]["tables"]
    assert (limit["x"][0], limit["x"][-1]) == (1, 150)
    (curve,) = living["curves"]
    assert (curve["name"], curve["kind"]) == ("alive", "line")
    assert curve["values"] == [
        sum(alive(world, row, tick + 50) for row in range(len(world))) for tick in living["x"]
    ]
    (rates,) = panels["Births and deaths"]["tables"]
    edges = series.bins(150).tolist()
    births = [
        sum(low < born - 50 <= high for born in range(0, 180, 3)) / (high - low)
        for low, high in pairwise(edges)
    ]
    shown = rates["curves"][0]["values"]
    assert all(value is None or close([value], [births[i]]) for i, value in enumerate(shown))
    assert any(shown)


@pytest.mark.parametrize("worlds", [8, 9])
def test_up_to_eight_worlds_have_a_curve_each(worlds: int) -> None:
    values = np.arange(2.0 * worlds).reshape(worlds, 2)
    made = curves.over_worlds("some", np.arange(1, 3), values, "#000000")["curves"]
    faint = [each["values"] for each in made if each["kind"] == "faint"]
    assert faint == (values.tolist() if worlds == 8 else [])
    assert made[-1]["name"] == f"some, median and quartiles of {worlds} worlds"


@pytest.mark.parametrize(("rate", "unit"), [(50.0, "second"), (None, "tick")])
def test_food_is_shown_in_the_units_of_the_habitat(
    rate: float | None, unit: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    food = np.array([[0.01, 0.02, 0.03], [0.02, 0.04, np.nan]])
    enough = np.array([[0.1, 0.1, np.inf], [0.1, 0.1, np.inf]])
    found = Foraging(0, np.array([5.0, 15.0, 25.0]), food, enough)
    monkeypatch.setattr(curves, "foraging", lambda run: found)
    more: dict[str, Any] = {"description": SimpleNamespace(rate=rate, tallies=())}
    panel = named(unequal(), config=config(TORUS, seeds=2), **more)["Food"]
    assert (panel["x"], panel["y"]) == ("time (ticks)", f"food in a {unit}")
    gathered, needed = panel["tables"]
    times = rate or 1
    shown = {each["name"]: each for each in (*gathered["curves"], *needed["curves"])}
    some = shown["food, median and quartiles of 2 worlds"]
    assert some["values"] == pytest.approx([0.015 * times, 0.03 * times, 0.03 * times])
    limit = shown["break-even, median and quartiles of 2 worlds"]
    assert limit["values"][2] is None
    assert limit["values"][:2] == pytest.approx([0.1 * times] * 2)
    assert (some["colour"], limit["colour"]) == (style.BLUE, style.ORANGE)
    assert [each["kind"] for each in needed["curves"]] == ["high", "low", "line"]


def test_a_count_of_the_habitat_has_its_mean_and_best_at_the_samples_of_each_world() -> None:
    """World 1 has no sample at tick 20, and world 2 has none at all."""
    metrics = pa.table(
        {
            "world": [0, 1, 0, 0, 1],
            "tick": [10, 10, 20, 30, 30],
            "score_mean": [1.0, 3.0, 5.0, 7.0, 10.0],
            "score_best": [10.0, 30.0, 50.0, 70.0, 100.0],
        }
    )
    more: dict[str, Any] = {"description": SimpleNamespace(rate=None, tallies=("score",))}
    run = config(TORUS, seeds=3, metabolism=None)
    panel = named(unequal(), metrics=metrics, config=run, **more)["score of the living"]
    assert (panel["x"], panel["y"]) == ("time (ticks)", "score")
    colours = style.BLUE, style.ORANGE
    for table, name, colour, size in zip(
        panel["tables"], ("mean", "best"), colours, (1, 10), strict=True
    ):
        assert table["x"] == [10, 20, 30]
        *_, middle = table["curves"]
        assert middle["name"] == f"{name}, median and quartiles of 3 worlds"
        assert middle["colour"] == colour
        assert middle["values"] == [2 * size, None, 8.5 * size]


def test_each_count_of_a_habitat_has_its_panel_with_a_limited_number_of_samples(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Four points are allowed, so every third of ten samples is shown."""
    monkeypatch.setattr(curves, "POINTS", 4)
    at = np.arange(10)
    sizes = {"score_mean": 1.0, "score_best": 2.0, "goals_mean": 3.0, "goals_best": 4.0}
    columns = {name: at * size for name, size in sizes.items()}
    metrics = pa.table({"world": 0 * at, "tick": 50 * at, **columns})
    more: dict[str, Any] = {"description": SimpleNamespace(rate=None, tallies=("score", "goals"))}
    run = config(TORUS, seeds=1, metabolism=None)
    panels = named(unequal().of_world(0), metrics=metrics, config=run, **more)
    for column, size in sizes.items():
        name, part = column.split("_")
        panel = panels[f"{name} of the living"]
        assert panel["y"] == name
        (table,) = (each for each in panel["tables"] if each["curves"][0]["name"] == part)
        assert table["x"] == [0, 150, 300, 450]
        assert table["curves"][0]["values"] == [0, 3 * size, 6 * size, 9 * size]


def test_numbers_of_a_page_have_five_digits_and_no_fraction_if_they_are_whole() -> None:
    values = curves.numbers(np.array([1 / 3, 123456.0, 2.0, np.nan, np.inf]))
    assert values == [0.33333, 123460, 2, None, None]
    assert [type(value) for value in values[1:3]] == [int, int]


def test_curves_go_on_until_the_last_tick_of_any_world() -> None:
    """The first of two worlds is the shorter one."""
    worlds = [world_of(SHORT, ENDS[1]), world_of(LONG, ENDS[0])]
    panels = named(joined(worlds, np.array([0, 1])))
    for title in ("Organisms alive", "Mean age of the living"):
        for table in panels[title]["tables"]:
            assert table["x"][-1] == ENDS[0]
