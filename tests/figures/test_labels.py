"""Titles, labels, keys and limits of the panels, also of a fork."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation, Text

from primordia.figures import ages, population, style, survival, threshold
from primordia.history.foraging import Foraging
from primordia.law.world import Cause
from primordia.runs.lives import Lives
from tests.figures.reading import axes_of, food_panel, key, labels, lines, run_of
from tests.synthetic import world_of, worlds_of

CELLS = 1500
ONE = [(0, 20, True), (1, 50, True), (2, 30, True), (5, 0, False), (7, 40, True)]
KINDS = {
    "one": (world_of(ONE, until=700), "time (ticks)", 700),
    "two": (worlds_of(ONE, [(0, 3, False)], until=700), "time (ticks)", 700),
    "fork": (worlds_of(ONE, ONE, until=700).recorded_since(6), "time since the fork (ticks)", 694),
}
KINDS["two"][0].cause[:2] = Cause.STARVED, Cause.REPLACED
KINDS["two"][0].ended[3] = 600  # the first world stopped earlier
SPREAD = {"median and quartiles of 2 worlds": style.BLUE}
POOLED = {"2 worlds together": style.SOFT}


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def test_labels_and_limits_of_population(kind: str) -> None:
    lives, time, last = KINDS[kind]
    living, fates, rates = axes_of(population.draw, run_of(lives, cells=CELLS), 0)
    several = kind != "one"
    assert labels(living) == ("Population", time, "organisms")
    assert labels(fates) == ("Fate of all organisms born", time, "")
    per_tick = "per tick of a world" if several else "per tick"
    assert labels(rates) == ("Births and deaths", time, per_tick)
    assert {each.get_xlim() for each in (living, fates, rates)} == {(1, last)}
    assert key(living) == (SPREAD if several else {})
    causes = {
        "two": [("fatal", style.VERMILION), ("starved", style.ORANGE), ("replaced", style.SKY)]
    }.get(kind, [("fatal", style.VERMILION)])
    (first, colour), *others = causes
    dead = {f"dead: {first}": colour, **dict(others)}
    assert key(fates) == {"alive": style.BLUE, **dead, **(POOLED if several else {})}
    assert key(rates) == {"births": style.INK, f"deaths: {first}": colour, **dict(others)}
    (limit,) = lines(living, style.FAINT)
    assert limit[1].tolist() == [CELLS, CELLS]
    assert "all 1,500 cells" in {each.get_text() for each in living.texts}
    assert living.get_ylim() == (0, pytest.approx(1.12 * CELLS)), "room for the words"


def test_labels_and_limits_of_ages(kind: str) -> None:
    lives, time, last = KINDS[kind]
    over_time, over_births, dead = axes_of(ages.draw, run_of(lives), 0)
    assert labels(over_time) == ("Mean age of the living over time", time, "age (ticks)")
    title = "Mean age of the living over births"
    assert labels(over_births) == (title, "organisms born so far", "")
    assert labels(dead) == ("Lifespan of each organism", "organism, in order of birth", "")
    assert over_time.get_xlim() == (1, last)
    assert key(over_time) == key(over_births) == (SPREAD if kind != "one" else {})
    words = {"dead": style.SKY, "median and quartiles": style.BLUE, "still alive": style.ORANGE}
    assert key(dead) == words
    assert dead.get_yscale() == "log"
    assert dead.get_ylim()[0] == 1


def test_labels_and_limits_of_survival(kind: str) -> None:
    lives, time, last = KINDS[kind]
    alive, by_age, over_time = axes_of(survival.draw, run_of(lives), 0)
    risk = "deaths per tick lived"
    assert labels(alive) == ("Alive at each age", "age (ticks)", "fraction alive")
    assert labels(by_age) == ("Risk of death by age", "age (ticks)", risk)
    assert labels(over_time) == ("Risk of death over time", time, risk)
    longest = lives.lifespan.max()
    assert alive.get_xlim() == by_age.get_xlim() == (1, longest)
    assert over_time.get_xlim() == (1, last)
    for axes in (alive, by_age, over_time):
        assert key(axes) == (POOLED if kind != "one" else {})
        assert "no deaths yet" not in {each.get_text() for each in axes.findobj(Text)}
    assert "at risk, born in the" in {each.get_text() for each in alive.texts}
    curves = [len(lines(alive, colour)) for colour in survival.COHORTS.values()]
    assert curves == [1] * 4, "also of a quarter with one organism"


@pytest.mark.parametrize("longest", [10, 1000])
def test_the_age_at_the_end_of_the_axis_has_its_numbers_at_risk(longest: int) -> None:
    lives = world_of([(0, longest - 1, True), (1, 4, True)] * 4, until=longest + 9)
    (alive, *_) = axes_of(survival.draw, run_of(lives), 0)
    assert alive.get_xlim() == (1, longest)
    notes = [each for each in alive.texts if isinstance(each, Annotation)]
    written = {x: [each.get_text() for each in notes if each.xy[0] == x] for x in (1, longest)}
    assert written == {1: ["2"] * 4, longest: ["2", "2", "0", "0"]}


def test_an_axis_of_time_holds_at_least_ten_ticks() -> None:
    axes = Figure().subplots()
    for last, end in ((3, 10), (11, 11)):
        style.time_axis(axes, last, "time")
        assert axes.get_xlim() == (1, end)


def foraged(food: np.ndarray, enough: np.ndarray) -> Axes:
    middle = np.linspace(30, 90, food.shape[1]) if food.shape[1] else np.zeros(0)
    return food_panel(Foraging(25, middle, food, enough))


def test_an_infinite_break_even_is_not_drawn() -> None:
    food = np.array([[0.25, 0.5, 0.75], [0.5, -0.75, 1.0]])
    enough = np.array([[np.inf, 0.5, 0.25], [np.inf, 0.75, 0.5]])
    axes = foraged(food, enough)
    *worlds, (_, median) = lines(axes, style.ORANGE)
    shown = np.where(np.isinf(enough), np.nan, enough)
    np.testing.assert_array_equal([y for _, y in worlds], shown)
    np.testing.assert_array_equal(median, [np.nan, 0.625, 0.375])
    assert labels(axes) == ("Food an organism gathers in a tick", "time (ticks)", "")
    assert key(axes) == {**SPREAD, "break-even": style.ORANGE}
    assert axes.get_xlim()[0] == 25
    assert axes.get_ylim()[0] < -0.75, "food may be lost"
    nowhere = foraged(np.abs(food[:1]), np.full((1, 3), np.inf))
    assert (key(nowhere), lines(nowhere, style.ORANGE)) == ({}, [])
    assert nowhere.get_ylim()[0] == 0
    assert "no samples yet" not in {each.get_text() for each in nowhere.texts}


def test_the_panel_of_food_says_if_there_are_no_samples_yet() -> None:
    axes = foraged(np.zeros((1, 0)), np.zeros((1, 0)))
    assert "no samples yet" in {each.get_text() for each in axes.texts}
    assert len(axes.get_yticks()) == 0


@pytest.mark.parametrize("worlds", [1, 2])
def test_labels_and_curves_of_the_threshold(worlds: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Unknown values are gaps in the curve. Of two worlds, only the last and larger has known values."""
    lives = worlds_of(*([(0, 3, True)] * count for count in (380, 500)[-worlds:]), until=9)
    measured = SimpleNamespace(mutated=0.0, as_good=None, held=2.0)
    unknown = SimpleNamespace(mutated=None, as_good=None, held=None)
    found = [[unknown, unknown], [measured, unknown]][-worlds:]
    monkeypatch.setattr(threshold, "over_births", lambda world, *_: found[world])
    axes = axes_of(threshold.draw, run_of(lives), 0)
    titles = "p: children that mutate", "v: mutants as good", "Does a good line persist?"
    spread = SPREAD if worlds == 2 else {}
    for each, title, value in zip(axes, titles, (0.0, np.nan, 2.0), strict=True):
        last = title == titles[2]
        assert labels(each) == (title, "organisms born so far", "s (1 - p (1 - v))" * last)
        assert each.get_xlim() == (0, 500)
        assert key(each) == {**spread, **({"threshold": style.VERMILION} if last else {})}
        x, y = lines(each, style.BLUE)[worlds - 1]
        np.testing.assert_array_equal((x, y), ([125, 375], [value, np.nan]))
        assert [y.tolist() for _, y in lines(each, style.VERMILION)] == [[1, 1]] * last
    assert axes[2].get_yscale() == "log"


def test_a_threshold_that_is_unknown_everywhere_is_not_drawn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The number of stretches follows from the births of the largest world, and is at most 20."""
    edges = []

    def noted(world: int, lives: Lives, of_births: np.ndarray, acts: bool) -> list[Any]:
        edges.append((world, len(lives), of_births.tolist()))
        return [SimpleNamespace(held=None)]

    monkeypatch.setattr(threshold, "over_births", noted)
    for births, count in ((200 * 25, 20), (1234, 6), (400, 2)):
        edges.clear()
        lives = worlds_of([(0, 3, True)] * 7, [(0, 3, True)] * births, until=9)
        assert threshold.draw(run_of(lives), 0) is None
        expected = [int(births * k / count) for k in range(count + 1)]
        assert edges == [(0, 7, expected), (1, births, expected)]
