"""Figures draw what the records say: data are read back from the axes and counted life by life."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Annotation

from primordia.comparison.comparison import ComparedArm, Comparison
from primordia.comparison.gathering import Gathering
from primordia.comparison.measured import Measured
from primordia.comparison.pace import WINDOWS, Pace
from primordia.comparison.survival import survival as survived
from primordia.figures import ages, comparison, foraging, population, style, survival, threshold
from primordia.figures import lines as descents
from primordia.history import series
from primordia.history.extinctions import Extinctions
from primordia.history.foraging import Foraging
from primordia.history.threshold import over_births
from primordia.law.world import Cause
from primordia.phylogeny.lines import lines_of_world
from primordia.runs.lives import ALIVE, Lives
from tests.assays.lives import COPY, FOUNDER, MUTANT
from tests.assays.lives import lives as lives_of
from tests.figures.reading import edges_at, lines
from tests.synthetic import alive, worlds_of
from tests.worlds import MEADOW, config

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


LIVES = some_lives()
WORLDS = [LIVES.of_world(world) for world in range(3)]


def axes_of(draw: Any, lives: Lives = LIVES) -> list[Axes]:
    run: Any = SimpleNamespace(lives=lives, config=config(MEADOW, cells=64, seeds=3))
    with style.applied():
        figure = draw(run, 0)
    return figure.axes


def check_worlds(axes: Axes, expected: np.ndarray, x: np.ndarray, colour: str) -> None:
    """Check the curves of all worlds (W, X), their median and their quartiles."""
    *worlds, (place, median) = lines(axes, colour)
    assert len(worlds) == len(expected)
    for (at, drawn), values in zip(worlds, expected, strict=True):
        np.testing.assert_array_equal(at, x)
        np.testing.assert_allclose(drawn, values, rtol=1e-12)
    q1, q2, q3 = np.nanpercentile(expected, [25, 50, 75], axis=0)
    np.testing.assert_array_equal(place, x)
    np.testing.assert_allclose(median, q2, rtol=1e-12)
    for at in range(0, len(x), max(1, len(x) // 7)):
        np.testing.assert_allclose(edges_at(axes.collections[0], x[at]), (q1[at], q3[at]))


def counted(world: Lives, tick: int) -> list[int]:
    """Return the ages of the living of a world after a tick."""
    rows = [row for row in range(len(world)) if alive(world, row, tick)]
    return [tick - int(world.born[row]) for row in rows]


def test_population_is_drawn_as_counted() -> None:
    living, fates, rates = axes_of(population.draw)
    ticks = series.moments(UNTIL)
    numbers = np.array([[len(counted(world, tick)) for tick in ticks] for world in WORLDS], float)
    check_worlds(living, numbers, ticks, population.LIVING)
    check_fates(fates, ticks)
    check_rates(rates, LIVES)


def test_a_world_that_stopped_early_adds_no_ticks_to_later_rates() -> None:
    then, early = 40, LIVES.world == 1
    lives = LIVES.take(np.flatnonzero(~early | (LIVES.born <= then)))
    late = (lives.world == 1) & (lives.ended > then)
    lives.ended[late], lives.cause[late] = then, ALIVE
    check_rates(axes_of(population.draw, lives)[-1], lives)


def check_fates(axes: Axes, ticks: np.ndarray) -> None:
    colours = [*(population.COLOURS[cause] for cause in CAUSES), population.LIVING]
    assert [to_hex(each.get_facecolor()[0]) for each in axes.collections] == colours
    for tick in ticks[::15].tolist():
        low, high = zip(*(edges_at(each, tick) for each in axes.collections), strict=True)
        heights = np.subtract(high, low).tolist()
        dead = [((LIVES.cause == cause) & (LIVES.ended <= tick)).sum() for cause in CAUSES]
        assert heights == [*dead, sum(len(counted(world, tick)) for world in WORLDS)]


def check_rates(axes: Axes, lives: Lives) -> None:
    edges = series.bins(UNTIL)
    ends = [lives.of_world(world).ended.max() for world in range(3)]
    events = [lives.born, *(lives.ended[lives.cause == cause] for cause in CAUSES)]
    drawn = lines(axes)
    assert len(drawn) == len(events)
    for (x, y), at in zip(drawn, events, strict=True):
        assert ((edges[:-1] < x) & (x <= edges[1:])).all()
        for k, value in enumerate(y):
            count = ((edges[k] < at) & (at <= edges[k + 1])).sum()
            expected = count / np.diff(np.minimum.outer(edges[k : k + 2], ends).sum(axis=1))[0]
            assert (value == expected) if count >= series.MIN_EVENTS else np.isnan(value)


def test_ages_are_drawn_as_counted() -> None:
    over_time, over_births, dead = axes_of(ages.draw)
    ticks, number = series.moments(UNTIL), np.arange(1, 151)

    def mean(world: Lives, tick: int) -> float:
        now = counted(world, tick)
        return float(np.mean(now)) if sum(now) else np.nan

    by_time = np.array([[mean(world, tick) for tick in ticks] for world in WORLDS])
    check_worlds(over_time, by_time, ticks, style.BLUE)
    by_birth = np.array([[mean(world, tick) for tick in world.born] for world in WORLDS])
    x, y = lines(over_births, style.BLUE)[1]
    np.testing.assert_array_equal(x, number)
    np.testing.assert_allclose(y, by_birth[1])
    for colour, group in ((style.SKY, LIVES.died), (style.ORANGE, ~LIVES.died)):
        ((x, y),) = lines(dead, colour)
        np.testing.assert_array_equal(x, np.tile(number, 3)[group])
        np.testing.assert_array_equal(y, np.maximum(LIVES.lifespan[group], 1))
    check_quartiles(dead)


def check_quartiles(axes: Axes) -> None:
    ((middle, median),) = lines(axes, style.BLUE)
    rank, lifespan = (LIVES.rank + 1)[LIVES.died], LIVES.lifespan[LIVES.died]
    order = np.argsort(rank, kind="stable")
    parts = np.array_split(order, len(order) // ages.ENOUGH)
    assert len(parts) == len(middle)
    for part, at, half in zip(parts, middle, median, strict=True):
        q1, q2, q3 = np.percentile(lifespan[part], [25, 50, 75])
        assert (at, half) == (rank[part].mean(), q2)
        np.testing.assert_allclose(edges_at(axes.collections[0], at), (q1, q3))


def test_survival_is_drawn_as_counted() -> None:
    alive_axes, by_age, over_time = axes_of(survival.draw)
    quarter = LIVES.rank * 4 // 150
    for number, colour in enumerate(survival.COHORTS.values()):
        cohort = LIVES.take(quarter == number)
        ((x, y),) = lines(alive_axes, colour)
        share, steps = 1.0, dict(zip(x.tolist(), y.tolist(), strict=True))
        for age in range(int(LIVES.lifespan.max()) + 1):
            at_risk = (cohort.lifespan >= age).sum()
            died = (cohort.died & (cohort.lifespan == age)).sum()
            share *= 1 - died / max(at_risk, 1)
            assert not died or steps[age] == pytest.approx(share)
        ((_, risk),) = lines(by_age, colour)
        check_risk(risk, cohort.lifespan, cohort.lifespan[cohort.died], np.zeros(len(cohort)))
    ((_, risk),) = lines(over_time)
    check_risk(risk, LIVES.ended, LIVES.ended[LIVES.died], LIVES.born)


@pytest.mark.parametrize("fork", [None, 60])
def test_numbers_at_risk_are_counted_at_each_labelled_age(fork: int | None) -> None:
    """An organism is at risk up to the age at which its life ends. If it was alive at a fork, it is at
    risk only after its age there."""
    lives = LIVES if fork is None else LIVES.recorded_since(fork)
    alive_axes, _, _ = axes_of(survival.draw, lives)
    drawn = [each for each in alive_axes.texts if isinstance(each, Annotation)]
    quarter = lives.rank * 4 // np.bincount(lives.world)[lives.world]
    assert (lives.lifespan == 10).any(), "some lives end at a labelled age"
    for number, (name, colour) in enumerate(survival.COHORTS.items()):
        cohort = lives.take(quarter == number)
        written = {each.xy[0]: each.get_text() for each in drawn if each.get_color() == colour}
        assert written.pop(0.3) == name
        assert {1, 10} <= written.keys()
        for age, text in written.items():
            ends, begins = cohort.lifespan.tolist(), (cohort.seen - cohort.born).tolist()
            at_risk = sum(a < age <= b for a, b in zip(begins, ends, strict=True))
            assert text == str(at_risk)


def check_risk(drawn: np.ndarray, stop: np.ndarray, died: np.ndarray, start: np.ndarray) -> None:
    edges = series.bins(int(LIVES.lifespan.max() if not start.any() else UNTIL))
    for k, value in enumerate(drawn):
        low, high = edges[k], edges[k + 1]
        count = ((low < died) & (died <= high)).sum()
        lived = (np.clip(stop, low, high) - np.clip(start, low, high)).sum()
        assert np.isnan(value) if count < series.MIN_EVENTS else value == count / lived


@pytest.mark.parametrize(("rate", "unit"), [(50.0, "second"), (None, "tick")])
def test_food_is_drawn_in_the_unit_of_its_title(
    rate: float | None, unit: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw = np.random.default_rng(1)
    food, enough = draw.random((3, 9)), draw.random((3, 9))
    measured = Foraging(7, np.linspace(10, 90, 9), food, enough)
    monkeypatch.setattr(foraging, "foraging", lambda _: measured)
    run: Any = SimpleNamespace(
        config=SimpleNamespace(metabolism=True), description=SimpleNamespace(rate=rate)
    )
    with style.applied():
        figure = foraging.draw(run, 0)
    assert figure is not None
    (axes,) = figure.axes
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
    run: Any = SimpleNamespace(lives=world)
    with style.applied():
        figure = threshold.draw(run, 0)
    assert figure is not None
    edges = np.linspace(0, len(world), len(world) // threshold.ENOUGH + 1).astype(int)
    expected = over_births(0, world, edges)
    assert len(expected) == 4
    for axes, name in zip(figure.axes, ("mutated", "as_good", "held"), strict=True):
        ((x, y),) = lines(axes, style.BLUE)
        np.testing.assert_allclose(x, (edges[1:] + edges[:-1]) / 2)
        np.testing.assert_allclose(y, [getattr(each, name) for each in expected])
    few: Any = SimpleNamespace(lives=lives_of(*rows[:300]))
    assert threshold.draw(few, 0) is None


def test_new_common_ancestors_are_marked_at_the_time_since_the_lines_were_founded() -> None:
    """Organism 1 is the common ancestor from tick 30 on, and organism 2 from tick 60 on."""
    rows: list = [(-1, FOUNDER, 30), (0, COPY, 59), (1, COPY, 98, "alive"), (2, COPY, 97, "alive")]
    for founded, expected in ((10, [20, 50]), (40, [20]), (70, [])):
        found = lines_of_world(0, lives_of(*rows), founded, 0)
        with style.applied():
            diversity = descents.draw(found).axes[2]
        marks = [x.tolist() for x, _ in lines(diversity, style.ORANGE)]
        assert marks == [[since, since] for since in expected]


SEEDS = np.arange(3)
NONE = Extinctions(np.zeros(3, np.int64), np.zeros(3, np.int64))


def arm(name: str, seed: int, known: bool = True) -> ComparedArm:
    """Return a run of three worlds with invented values, of which one may be unknown."""
    draw = np.random.default_rng(seed)
    is_known = np.array([True, True, known])

    def measured(scale: float) -> Measured:
        return Measured(np.sort(draw.integers(1, 90, 3) * scale), is_known)

    outcomes = ("first", "births", "ticks", "lifespan", "longest", "pace", "food")
    values = {outcome: measured(10.0**k) for k, outcome in enumerate(outcomes)}
    edges = np.linspace(0, UNTIL, WINDOWS + 1)
    deaths = draw.integers(1, 9, (3, WINDOWS))
    paces = Pace(edges, draw.integers(1, 900, (3, WINDOWS)).astype(float), deaths)
    gathered = Gathering(draw.random((3, WINDOWS)), values["food"])
    return ComparedArm(
        name, {}, SEEDS, values, survived(LIVES, 3, 100 + seed), paces, gathered, NONE
    )


def drawn(*arms: ComparedArm) -> Figure:
    with style.applied():
        return comparison.draw(Comparison("t", arms, 100, 0, None, None, "tick"))


def test_a_comparison_draws_the_values_of_each_run() -> None:
    arms = arm("one", 1), arm("two", 2, known=False)
    alive_axes, by_births, by_time, food = drawn(*arms).axes
    colours = [to_hex(look["color"]) for look in comparison.line_styles(2)]
    for each, colour in zip(arms, colours, strict=True):
        ((x, y),) = lines(alive_axes, colour)
        np.testing.assert_array_equal(x, np.maximum(each.survival.steps, 1))
        np.testing.assert_array_equal(y, [1, *each.survival.curve, each.survival.curve[-1]])
        for axes, unit in ((by_births, "births"), (by_time, "ticks")):
            check_saturated(axes, each.measured[unit], colour)
        check_medians(food, each.gathering.curve, colour)
    assert (by_births.get_xlabel(), by_time.get_xlabel()) == ("births", "time (ticks)")


def check_saturated(axes: Axes, measured: Measured, colour: str) -> None:
    (x, share), (stopped, marks) = lines(axes, colour)
    for at, value in zip(x, share, strict=True):
        assert value == (measured.known & (measured.value <= at)).sum() / 3
    np.testing.assert_array_equal(stopped, measured.value[~measured.known])
    assert marks.tolist() == [2 / 3] * len(marks)


def check_medians(axes: Axes, curve: np.ndarray, colour: str) -> None:
    *worlds, (x, median) = lines(axes, colour)
    np.testing.assert_allclose(x, (np.arange(WINDOWS) + 0.5) * UNTIL / WINDOWS)
    np.testing.assert_array_equal([y for _, y in worlds], curve)
    np.testing.assert_array_equal(median, np.median(curve, axis=0))


def test_where_few_worlds_saturate_a_comparison_draws_ticks_for_each_death() -> None:
    unknown = Measured(np.ones(3), np.zeros(3, bool))
    one = arm("one", 3)
    one.measured.update(births=unknown, ticks=unknown)
    _, dying, _ = drawn(one).axes
    colour = to_hex(comparison.line_styles(1)[0]["color"])
    check_medians(dying, one.pace.lived / one.pace.deaths, colour)


def test_the_invented_lives_are_of_all_kinds() -> None:
    assert {*LIVES.cause.tolist()} == {ALIVE, *map(int, CAUSES)}
    assert (LIVES.ended[LIVES.died] == UNTIL).any(), "some die in the last tick"
