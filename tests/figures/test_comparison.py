"""The figure of a comparison draws the values of each run, their medians and what they mean."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from primordia.comparison.comparison import ComparedArm, Comparison
from primordia.comparison.gathering import Gathering
from primordia.comparison.measured import Measured
from primordia.comparison.pace import WINDOWS, Pace
from primordia.comparison.survival import survival as survived
from primordia.figures import comparison, style
from primordia.history.extinctions import Extinctions
from tests.figures.reading import lines
from tests.figures.test_drawn import LIVES, UNTIL

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
