"""The figure of a comparison: the values of each run, their medians, labels and legend."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure

from primordia.comparison.comparison import ComparedArm, Comparison
from primordia.comparison.measured import Measured
from primordia.comparison.pace import WINDOWS, Gathering, Pace
from primordia.comparison.survival import survival as survived
from primordia.figures import comparison, style
from primordia.history.extinctions import Extinctions
from tests.figures.reading import edges_at, labels, lines
from tests.figures.test_drawn import LIVES, UNTIL


def arm(name: str, seed: int, known: bool = True, worlds: int = 3) -> ComparedArm:
    """Return a run with invented values. `known`: whether the values of its last world are known."""
    draw = np.random.default_rng(seed)
    is_known = np.array([*[True] * (worlds - 1), known])

    def measured(scale: float) -> Measured:
        return Measured(np.sort(draw.integers(1, 90, worlds) * scale), is_known)

    outcomes = ("first", "births", "ticks", "lifespan", "longest", "pace", "food")
    values = {outcome: measured(10.0**k) for k, outcome in enumerate(outcomes)}
    edges = np.linspace(0, UNTIL, WINDOWS + 1)
    deaths = draw.integers(1, 9, (worlds, WINDOWS))
    paces = Pace(edges, draw.integers(1, 900, (worlds, WINDOWS)).astype(float), deaths)
    gathered = Gathering(draw.random((worlds, WINDOWS)), values["food"])
    none = Extinctions(np.zeros(worlds, np.int64), np.zeros(worlds, np.int64))
    survival = survived(LIVES, worlds, 100 + seed)
    return ComparedArm(name, {}, np.arange(worlds), values, survival, paces, gathered, none)


def drawn(*arms: ComparedArm, span: str = "tick") -> Figure:
    with style.applied():
        return comparison.draw(Comparison("t", arms, 100, 0, None, None, span))


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


def unsaturated(one: ComparedArm) -> ComparedArm:
    """Let no world of a run saturate."""
    unknown = Measured(np.ones(one.worlds), np.zeros(one.worlds, bool))
    one.measured.update(births=unknown, ticks=unknown)
    return one


def test_where_few_worlds_saturate_a_comparison_draws_ticks_for_each_death() -> None:
    one = unsaturated(arm("one", 3))
    figure = drawn(one, span="second")
    alive, dying, food = figure.axes
    colour = to_hex(comparison.line_styles(1)[0]["color"])
    check_medians(dying, one.pace.lived / one.pace.deaths, colour)
    worlds_and_median = "time (ticks): worlds and median"
    assert labels(alive) == ("Alive at each age", "age (ticks)", "fraction of organisms")
    assert labels(dying) == ("Ticks lived for each death", worlds_and_median, "")
    assert labels(food) == ("Food gathered in a second", worlds_and_median, "")
    assert alive.get_xlim() == (1, 100)
    assert dying.get_xlim() == food.get_xlim() == (0, UNTIL)
    assert (dying.get_yscale(), food.get_yscale()) == ("log", "linear")
    assert legend(figure) == ["one"], "saturation is not drawn, and has no mark"
    assert (rows_and_columns(figure), widths(figure)) == ((1, 3), [1, 1, 1])
    one.measured["food"] = one.measured["births"]
    two = drawn(one)
    assert (rows_and_columns(two), widths(two)) == ((1, 2), [1, 1.6])


def legend(figure: Figure) -> list[str]:
    return [each.get_text() for each in figure.legends[0].get_texts()]


def rows_and_columns(figure: Figure) -> tuple[int, int]:
    grid = figure.axes[0].get_gridspec()
    return grid.nrows, grid.ncols


def widths(figure: Figure) -> list[float]:
    return list(figure.axes[0].get_gridspec().get_width_ratios())


@pytest.mark.parametrize("known", [True, False])
def test_the_legend_explains_the_mark_of_worlds_that_stopped_unsaturated(known: bool) -> None:
    figure = drawn(arm("one", 1), arm("two", 2, known))
    assert legend(figure) == ["one", "two", *["stopped unsaturated"] * (not known)]
    alive, by_births, by_time, food = figure.axes
    words = "Saturated worlds by births", "births", "fraction of worlds"
    assert labels(by_births) == words
    assert labels(by_time) == ("Saturated worlds by time", "time (ticks)", "")
    assert labels(food)[0] == "Food gathered in a tick"
    assert rows_and_columns(figure) == (2, 2)
    assert alive.get_ylim() == by_births.get_ylim() == (-0.03, 1.03)


def test_a_run_without_any_saturated_world_is_marked_beside_one_that_saturated() -> None:
    figure = drawn(arm("one", 1), unsaturated(arm("two", 2)))
    assert legend(figure) == ["one", "two", "stopped unsaturated"]
    figure.draw_without_rendering()
    words = figure.legends[0].get_texts()
    assert len({round(each.get_window_extent().y0) for each in words}) == 1, "all are in one row"
    colour = to_hex(comparison.line_styles(2)[1]["color"])
    (_, share), (stopped, marks) = lines(figure.axes[1], colour)
    assert (set(share.tolist()), stopped.tolist(), marks.tolist()) == ({0}, [1], [0])


@pytest.mark.parametrize(
    ("values", "first", "last", "halves"),
    [
        ([29, 90, 999], 10, 1198.8, False),
        ([30, 90, 100], 30, 120, True),
        ([31, 90, 2600], 30, 3120, False),
        ([4, 90, 200], 3, 240, True),
        ([0, 0, 0], 1, 1.2, True),
    ],
)
def test_the_axis_of_saturation_begins_at_one_or_three_times_a_power_of_ten(
    values: list[int], first: float, last: float, halves: bool
) -> None:
    """The axis ends a fifth after the last value of any run. A short axis also has marks at 3, 30, ..."""
    arms = [arm(name, seed) for seed, name in enumerate(("one", "two", "three"))]
    least, middle, most = values
    of_arms = [middle] * 3, [least, middle, middle], [middle, middle, most]
    for each, some in zip(arms, of_arms, strict=True):
        each.measured["births"] = Measured(np.array(some, float), np.full(3, True))
    axes = drawn(*arms).axes[1]
    assert axes.get_xlim() == pytest.approx((first, last))
    places = axes.xaxis.get_major_locator().tick_values(1, 1000)
    assert (30 in np.round(places)) == halves


def test_intervals_of_survival_are_drawn_for_five_worlds_or_more() -> None:
    enough, few = arm("enough", 1, worlds=5), arm("few", 2, worlds=4)
    axes = drawn(enough, few).axes[0]
    (band,) = axes.collections
    colour = to_hex(comparison.line_styles(2)[0]["color"])
    assert to_hex(band.get_facecolor()[0]) == colour
    low, high = enough.survival.band
    places = enough.survival.ages.tolist()
    for k, age in enumerate(places[1:-1], 1):
        assert edges_at(band, age) == pytest.approx((low[k], high[k - 1])), "it falls in steps"
    for count, bands in ((5, 5), (6, 0)):
        assert len(drawn(*[enough] * count).axes[0].collections) == bands


@pytest.mark.parametrize(("limit", "shown"), [(5, True), (4, False)])
def test_each_world_has_a_curve_if_no_run_has_many_worlds_and_runs_are_few(
    limit: int, shown: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(comparison, "FEW_WORLDS", limit)
    one, other = arm("one", 1), arm("other", 2, worlds=5)
    food = drawn(one, other).axes[3]
    words = "time (ticks): worlds and median" if shown else "time (ticks): median of worlds"
    assert len(food.get_lines()) == (3 + 1 + 5 + 1 if shown else 2)
    assert food.get_xlabel() == words
    for count in (5, 6):
        food = drawn(*[one] * count).axes[3]
        assert len(food.get_lines()) == (5 * 4 if count == 5 else 6)


def test_few_runs_go_from_dark_to_light_and_many_have_distinct_colours() -> None:
    """The reference is always black. If all colours are used, lines are dashed, and then dotted."""

    def light(look: dict[str, str]) -> float:
        return float(np.dot(to_rgb(look["color"]), (0.299, 0.587, 0.114)))

    for arms in (1, 2, 5):
        reference, *others = comparison.line_styles(arms)
        assert (reference["color"], len(others)) == (style.INK, arms - 1)
        shades = [light(look) for look in others]
        assert shades == sorted(shades)
        assert all("linestyle" not in look for look in others)
    three, five = (comparison.line_styles(arms) for arms in (3, 5))
    assert (three[1], three[-1]) == (five[1], five[-1]), "three runs use the whole range of colours"
    colours = [style.INK, *style.PALETTE, style.SOFT]
    looks = [(look["color"], look["linestyle"]) for look in comparison.line_styles(28)]
    assert looks == [*((c, dash) for dash in ("-", "--", ":") for c in colours), (style.INK, "-")]
    assert comparison.line_styles(6)[5] == {"color": style.PURPLE, "linestyle": "-"}
