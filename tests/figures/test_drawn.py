"""Figures draw what the records say: data are read back from the axes and counted life by life."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.text import Annotation

from primordia.figures import ages, foraging, population, style, survival, threshold
from primordia.history import series
from primordia.history.foraging import Foraging
from primordia.history.threshold import over_births
from primordia.law.world import Cause
from primordia.runs.lives import ALIVE, Lives
from tests.assays.lives import COPY, FOUNDER, MUTANT
from tests.assays.lives import lives as lives_of
from tests.figures.reading import axes_of, edges_at, food_panel, lines, run_of
from tests.synthetic import alive, surviving, worlds_of

UNTIL = 160
CAUSES = [Cause.FATAL, Cause.STARVED, Cause.HAZARD]


def some_lives() -> Lives:
    """Return three worlds of 150 lives each, with deaths of three causes."""
    draw = np.random.default_rng(5)

    def life() -> tuple[int, int, bool]:
        born = int(draw.integers(0, 120))
        lifespan = int(draw.geometric(0.04))
        return born, lifespan, born + 1 + lifespan <= UNTIL

    lives = worlds_of(*([life() for _ in range(150)] for _ in range(3)), until=UNTIL)
    lives.cause[lives.died] = draw.choice(CAUSES, int(lives.died.sum()))
    return lives


def unequal(lives: Lives) -> Lives:
    """Return worlds of which the first has few births, and the second stopped at tick 40."""
    few, stopped = lives.rank < 41, (lives.world == 1) & (lives.born <= 40)
    some = lives.take(np.flatnonzero(np.where(lives.world == 0, few, stopped | (lives.world == 2))))
    late = (some.world == 1) & (some.ended > 40)
    some.ended[late], some.cause[late] = 40, ALIVE
    return some


def shifted(lives: Lives, then: int) -> Lives:
    """Return lives with their time counted from a tick."""
    born, seen, ended = lives.born - then, lives.seen - then, lives.ended - then
    return replace(lives, born=born, seen=seen, ended=ended)


FORK = 60
LIVES = some_lives()
KINDS = {"whole": LIVES, "fork": LIVES.recorded_since(FORK), "unequal": unequal(LIVES)}


@pytest.fixture(params=[pytest.param("whole", marks=pytest.mark.slow), "fork", "unequal"])
def lives(request: pytest.FixtureRequest) -> Lives:
    """Return the lives of a run; `since` counts their time from the fork."""
    return KINDS[request.param]


@pytest.fixture
def since(lives: Lives) -> Lives:
    return shifted(lives, FORK if lives is KINDS["fork"] else 0)


def panels(draw: Any, lives: Lives) -> list[Axes]:
    return axes_of(draw, run_of(lives, cells=64, seeds=3), 0)


def worlds(lives: Lives) -> list[Lives]:
    return [lives.take(np.flatnonzero(lives.world == world)) for world in range(3)]


def check_worlds(axes: Axes, expected: np.ndarray, x: np.ndarray, colour: str) -> None:
    """Check the curves of all worlds (W, X), and their median and quartiles where half have values."""
    *curves, (place, median) = lines(axes, colour)
    assert len(curves) == len(expected)
    for (at, drawn), values in zip(curves, expected, strict=True):
        np.testing.assert_array_equal(at, x)
        np.testing.assert_allclose(drawn, values, rtol=1e-12)
    enough = np.isfinite(expected).sum(axis=0) * 2 >= len(expected)
    quartiles = np.full((3, len(x)), np.nan)
    quartiles[:, enough] = np.nanpercentile(expected[:, enough], [25, 50, 75], axis=0)
    q1, q2, q3 = quartiles
    np.testing.assert_array_equal(place, x)
    np.testing.assert_allclose(median, q2, rtol=1e-12)
    for at in np.flatnonzero(enough)[:: max(1, len(x) // 7)].tolist():
        np.testing.assert_allclose(edges_at(axes.collections[0], x[at]), (q1[at], q3[at]))


def counted(world: Lives, tick: int) -> list[int]:
    """Return the ages of the living of a world after a tick."""
    rows = [row for row in range(len(world)) if alive(world, row, tick)]
    return [tick - int(world.born[row]) for row in rows]


def by_tick(since: Lives, ticks: np.ndarray, value: Callable[[list[int]], float]) -> np.ndarray:
    """Return a value of the ages of the living in each world after each tick; NaN after its end."""
    return np.array(
        [
            [value(counted(world, tick)) if tick <= world.ended.max() else np.nan for tick in ticks]
            for world in worlds(since)
        ]
    )


def mean(ages: list[int]) -> float:
    return float(np.mean(ages)) if sum(ages) else np.nan


def test_population_is_drawn_as_counted(lives: Lives, since: Lives) -> None:
    living, fates, rates = panels(population.draw, lives)
    ticks = series.moments(int(since.ended.max()))
    check_worlds(living, by_tick(since, ticks, len), ticks, population.LIVING)
    check_fates(fates, ticks, since)
    check_rates(rates, since)


def check_fates(axes: Axes, ticks: np.ndarray, since: Lives) -> None:
    colours = [*(population.COLOURS[cause] for cause in CAUSES), population.LIVING]
    assert [to_hex(each.get_facecolor()[0]) for each in axes.collections] == colours
    for tick in ticks[::15].tolist():
        low, high = zip(*(edges_at(each, tick) for each in axes.collections), strict=True)
        heights = np.subtract(high, low).tolist()
        dead = [((since.cause == cause) & (since.ended <= tick)).sum() for cause in CAUSES]
        assert heights == [*dead, sum(len(counted(world, tick)) for world in worlds(since))]


def check_rates(axes: Axes, since: Lives) -> None:
    """A world that stopped early adds no ticks to later rates."""
    edges = series.bins(int(since.ended.max()))
    ends = [world.ended.max() for world in worlds(since)]
    events = [since.born, *(since.ended[since.cause == cause] for cause in CAUSES)]
    drawn = lines(axes)
    assert len(drawn) == len(events)
    for (x, y), at in zip(drawn, events, strict=True):
        assert ((edges[:-1] < x) & (x <= edges[1:])).all()
        for k, value in enumerate(y):
            count = ((edges[k] < at) & (at <= edges[k + 1])).sum()
            expected = count / np.diff(np.minimum.outer(edges[k : k + 2], ends).sum(axis=1))[0]
            assert (value == expected) if count >= series.MIN_EVENTS else np.isnan(value)


def test_ages_are_drawn_as_counted(lives: Lives, since: Lives) -> None:
    over_time, over_births, dead = panels(ages.draw, lives)
    ticks = series.moments(int(since.ended.max()))
    check_worlds(over_time, by_tick(since, ticks, mean), ticks, style.BLUE)
    number = np.arange(1, max(map(len, worlds(since))) + 1)
    by_birth = np.full((3, len(number)), np.nan)
    for ages_of_world, world in zip(by_birth, worlds(since), strict=True):
        begun = np.maximum(world.born, 0)  # organisms alive at the fork are seen from there on
        ages_of_world[: len(world)] = [mean(counted(world, tick)) for tick in begun]
    check_worlds(over_births, by_birth, number, style.BLUE)
    assert over_births.get_xlim() == (0, number[-1] + 1)
    rank = np.concatenate([np.arange(1, len(world) + 1) for world in worlds(since)])
    for colour, group in ((style.SKY, since.died), (style.ORANGE, ~since.died)):
        ((x, y),) = lines(dead, colour)
        np.testing.assert_array_equal(x, rank[group])
        np.testing.assert_array_equal(y, np.maximum(since.lifespan[group], 1))
    assert dead.get_xlim() == (0, number[-1] + 1)
    check_quartiles(dead, rank[since.died], since.lifespan[since.died])


def check_quartiles(axes: Axes, rank: np.ndarray, lifespan: np.ndarray) -> None:
    ((middle, median),) = lines(axes, style.BLUE)
    order = np.argsort(rank, kind="stable")
    parts = np.array_split(order, len(order) // ages.ENOUGH)
    assert len(parts) == len(middle)
    for part, at, half in zip(parts, middle, median, strict=True):
        q1, q2, q3 = np.percentile(lifespan[part], [25, 50, 75])
        assert (at, half) == (rank[part].mean(), q2)
        np.testing.assert_allclose(edges_at(axes.collections[0], at), (q1, q3))


def test_no_more_dots_are_drawn_than_there_is_room_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the dead, and of the living, every n-th one has a dot, beginning with the first."""
    monkeypatch.setattr(ages, "DOTS", 12)
    _, _, axes = panels(ages.draw, LIVES)
    rank = np.tile(np.arange(1, 151), 3)
    for colour, group in ((style.SKY, LIVES.died), (style.ORANGE, ~LIVES.died)):
        ((x, _),) = lines(axes, colour)
        n = int(group.sum()) // 12 + 1
        assert 6 < len(x) <= 12
        np.testing.assert_array_equal(x, [rank[row] for row in np.flatnonzero(group)[::n]])


def cohorts(lives: Lives) -> list[Lives]:
    """Return the lives of each quarter of the births of a world."""
    quarter = np.concatenate([4 * np.arange(len(w)) // len(w) for w in worlds(lives)])
    return [lives.take(quarter == number) for number in range(4)]


def test_survival_is_drawn_as_counted(lives: Lives, since: Lives) -> None:
    """An organism is at risk up to the age at which its life ends. An organism that was alive at a fork
    is at risk only after its age there."""
    alive_axes, by_age, over_time = panels(survival.draw, lives)
    assert (since.lifespan == 10).any(), "some lives end at a labelled age"
    for cohort, (name, colour) in zip(cohorts(since), survival.COHORTS.items(), strict=True):
        ((x, y),) = lines(alive_axes, colour)
        steps = dict(zip(x.tolist(), y.tolist(), strict=True))
        assert (x[0], x[-1], y[0]) == (0, since.lifespan.max(), 1)
        entered = np.maximum(-cohort.born, 0)
        shares = surviving(cohort, int(since.lifespan.max()))
        for age in set(cohort.lifespan[cohort.died].tolist()):
            assert steps[age] == pytest.approx(shares[age])
        check_at_risk(alive_axes, name, colour, entered, cohort.lifespan)
        ((_, risk),) = lines(by_age, colour)
        check_risk(risk, entered, cohort.lifespan, cohort.died, int(since.lifespan.max()))
    ((_, risk),) = lines(over_time)
    seen = np.maximum(since.born, 0)
    check_risk(risk, seen, since.ended, since.died, int(since.ended.max()))


def check_at_risk(
    axes: Axes, name: str, colour: str, entered: np.ndarray, lifespan: np.ndarray
) -> None:
    """Check the numbers below the axis, at 1, 10 and each further power of ten on the axis."""
    notes = [each for each in axes.texts if isinstance(each, Annotation)]
    written = {each.xy[0]: each.get_text() for each in notes if each.get_color() == colour}
    assert written.pop(0.3) == name
    assert [*written] == [age for age in (1, 10, 100) if age <= axes.get_xlim()[1]]
    for age, text in written.items():
        pairs = zip(entered.tolist(), lifespan.tolist(), strict=True)
        assert text == str(sum(begin < age <= end for begin, end in pairs))


def check_risk(
    drawn: np.ndarray, start: np.ndarray, stop: np.ndarray, died: np.ndarray, last: int
) -> None:
    edges = series.bins(last)
    assert len(drawn) == len(edges) - 1
    for k, value in enumerate(drawn):
        low, high = edges[k], edges[k + 1]
        count = (died & (low < stop) & (stop <= high)).sum()
        lived = (np.clip(stop, low, high) - np.clip(start, low, high)).sum()
        assert np.isnan(value) if count < series.MIN_EVENTS else value == count / lived


@pytest.mark.parametrize(("rate", "unit"), [(50.0, "second"), (None, "tick")])
def test_food_is_drawn_in_the_unit_of_its_title(rate: float | None, unit: str) -> None:
    draw = np.random.default_rng(1)
    food, enough = draw.random((3, 9)), draw.random((3, 9))
    measured = Foraging(7, np.linspace(10, 90, 9), food, enough)
    axes = food_panel(measured, rate)
    assert axes.get_title(loc="left").endswith(f"in a {unit}")
    check_worlds(axes, food * (rate or 1), measured.middle, style.BLUE)
    for (x, y), values in zip(lines(axes, foraging.BREAK_EVEN), enough, strict=False):
        np.testing.assert_array_equal(x, measured.middle)
        np.testing.assert_allclose(y, values * (rate or 1))


def test_the_threshold_is_drawn_stretch_by_stretch() -> None:
    """Two worlds of the same 800 births: 4 stretches of 200 each."""
    rows: list = [(-1, FOUNDER, 100), *((-1, FOUNDER, 1) for _ in range(99))]
    for good in (2, 5, 8, 10):
        rows += [(0, COPY, 100)] * 20 + [(0, MUTANT, 100)] * good + [(0, MUTANT, 1)] * (20 - good)
        rows += [(-1, FOUNDER, 1)] * 135
    world = lives_of(*rows)
    found = axes_of(threshold.draw, run_of(world), 0)
    edges = np.linspace(0, len(world), len(world) // threshold.ENOUGH + 1).astype(int)
    expected = over_births(0, world, edges)
    assert len(expected) == 4
    for axes, name in zip(found, ("mutated", "as_good", "held"), strict=True):
        ((x, y),) = lines(axes, style.BLUE)
        np.testing.assert_allclose(x, (edges[1:] + edges[:-1]) / 2)
        np.testing.assert_allclose(y, [getattr(each, name) for each in expected])
    assert threshold.draw(run_of(lives_of(*rows[:300])), 0) is None
