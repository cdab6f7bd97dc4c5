"""Figures of assays show what the assays found: data, medians, marks and words."""

from collections.abc import Sequence

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import AxLine

from primordia.assays.ablate import Ablation
from primordia.assays.compete import Competition
from primordia.assays.effects import Effect
from primordia.assays.garden import Bed
from primordia.assays.line import Line, Step
from primordia.figures import assays, style
from primordia.history.heredity import Inherited, Pairs
from primordia.history.threshold import Threshold
from tests.figures.reading import axes_of, edges_at, key, labels, lines, points, ticks


def levels(axes: Axes, colour: str = style.FAINT) -> list[float]:
    """Return the places of horizontal lines across the panel."""
    return [y[0] for x, y in lines(axes, colour) if x.tolist() == [0, 1]]


WORLDS: dict[str, str] = {"worlds": style.SKY, "median": style.BLUE}


def check_strips(axes: Axes, expected: dict[str, Sequence[float]]) -> None:
    """Check the dots and the median of each strip, and that nothing else is drawn in their colours."""
    assert ticks(axes.xaxis) == dict(enumerate(expected))
    dots, medians = lines(axes, style.SKY), lines(axes, style.BLUE)
    shown = {place: values for place, values in enumerate(expected.values()) if len(values)}
    assert len(dots) == len(medians) == len(shown)
    for (x, y), (across, median), (place, values) in zip(dots, medians, shown.items(), strict=True):
        assert y.tolist() == list(values)
        spread = [place - 0.25, place + 0.25]
        assert (x.tolist() == [place]) if len(values) == 1 else ([x[0], x[-1]] == spread)
        assert across.tolist() == spread
        assert median.tolist() == [float(np.median(values))] * 2
    low, high = axes.get_xlim()
    assert low < -0.25 < len(expected) - 0.75 < high


def test_ablations_are_drawn_in_order_with_the_median_of_the_organisms() -> None:
    lived = {"senses": [10.0, 20.0, 90.0, 30.0], "memory": [100.0, 100.0, 180.0, 50.0]}
    found = [
        Ablation(without, organism, 0, 100.0 if organism < 3 else 50.0, lifespan)
        for without, lifespans in lived.items()
        for organism, lifespan in enumerate(lifespans)
    ]
    (axes,) = axes_of(assays.ablate, found)
    shares = [0.1, 0.2, 0.9, 0.6], [1.0, 1.0, 1.8, 1.0]
    assert points(axes, style.SKY) == [(x, y) for y in (0, 1) for x in shares[y]]
    assert points(axes, style.BLUE) == [(pytest.approx(0.4), 0), (1, 1)]
    assert ticks(axes.yaxis) == {0: "senses", 1: "memory"}
    assert axes.get_ylim() == (1.5, -0.5), "the first is at the top"
    assert axes.get_xlim()[0] == 0
    assert [x for x, _ in points(axes, style.FAINT)] == [1, 1], "a whole life"
    assert labels(axes) == ("Life without each part", "share of the intact life", "")
    assert key(axes) == {"organisms": style.SKY, "median": style.BLUE}


def test_the_share_of_one_genome_is_drawn_in_each_world() -> None:
    tick = np.array([0, 30, 60, 90])
    share = np.array([[0.5, 0.6, 0.9, np.nan], [0.5, 0.4, 0.8, 1.0], [0.5, 0.1, 0.0, 0.2]])
    pairs = Competition("a", "b", tick, share), Competition("c", "d", 2 * tick, share[:1])
    several, single = axes_of(assays.compete, [*pairs])
    *worlds, (x, median) = lines(several, style.BLUE)
    np.testing.assert_array_equal([y for _, y in worlds], share)
    assert (x.tolist(), median.tolist()) == (tick.tolist(), [0.5, 0.4, 0.8, pytest.approx(0.6)])
    assert points(single, style.BLUE)[:3] == [(0, 0.5), (60, 0.6), (120, 0.9)]
    assert key(several) == {"median and quartiles of 3 worlds": style.BLUE}
    assert key(single) == {}
    for axes, name, last in ((several, "a", 90), (single, "c", 180)):
        assert labels(axes) == (f"Descendants of {name}", "time (ticks)", "share of the living")
        assert axes.get_xlim() == (0, last)
        assert levels(axes) == [0.5]


def test_effects_are_drawn_as_shares_of_mutants_with_quartiles_of_organisms() -> None:
    names = "as set", "scale 0.1", "scale 0.3", "differs 0.05", "differs 0.1"
    lived = np.random.default_rng(4).choice([5.0, 20 / 3, 10.0, 10.5, 11.0, 30.0], (5, 4, 12))
    found = [
        Effect(name, organism, 0, 10.0, mutants)
        for name, of_name in zip(names, lived, strict=True)
        for organism, mutants in enumerate(of_name)
    ]
    (axes,) = axes_of(assays.effects, found)
    assert ticks(axes.xaxis) == {k: name.replace(" ", "\n") for k, name in enumerate(names)}
    shares = {style.BLUE: lived == 10, style.GREEN: lived >= 11, style.VERMILION: lived < 7}
    for band, (colour, counted) in zip(axes.collections, shares.items(), strict=True):
        each = counted.mean(axis=2)
        means, *joined = lines(axes, colour)
        assert means[0].tolist() == [0, 1, 2, 3, 4]
        np.testing.assert_allclose(means[1], each.mean(axis=1))
        assert [x.tolist() for x, _ in joined] == [[1, 2], [3, 4]], "sizes of one kind are joined"
        for x, y in joined:
            np.testing.assert_array_equal(y, means[1][x.astype(int)])
        for place, of_name in enumerate(each):
            quartiles = np.percentile(of_name, 25), np.percentile(of_name, 75)
            np.testing.assert_allclose(edges_at(band, place), quartiles)
    words = ("as long", "a tenth longer", "a third shorter")
    assert key(axes) == dict(zip(words, shares, strict=True))
    assert axes.get_ylabel() == "share of mutants"


def beds() -> list[Bed]:
    """Return beds of two worlds of unequal size. Some lives are equally long, and one ended at once."""
    lives = {
        ("oldest", 0): ([9, 8, 0], [3.0, 0.0, 6.0]),
        ("oldest", 1): ([7], [6.0]),
        ("late-born", 0): ([2, 1], [2.5, 1.0]),
        ("late-born", 1): ([5, 4, 3], [2.5, 50.0, 8.0]),
        ("founders", 0): (None, [1.0, 1.5, 2.0]),
        ("founders", 1): (None, [2.0, 4.0, 1.0]),
    }
    return [
        Bed(group, world, np.arange(len(reborn)), recorded and np.array(recorded), np.array(reborn))
        for (group, world), (recorded, reborn) in lives.items()
    ]


def test_the_garden_is_drawn_as_pairs_of_lives_and_as_survival_of_each_group() -> None:
    pairs, again = axes_of(assays.garden, beds())
    assert points(pairs, style.BLUE) == [(9, 3), (8, 1), (1, 6), (7, 6)]
    assert points(pairs, style.ORANGE) == [(2, 2.5), (1, 1), (5, 2.5), (4, 50), (3, 8)]
    assert labels(pairs) == (
        "Organisms", "life as recorded (ticks)", "life when born again (ticks)"
    )  # fmt: skip
    (diagonal,) = (each for each in pairs.get_lines() if isinstance(each, AxLine))
    assert (diagonal.get_xy1(), diagonal.get_xy2()) == ((1, 1), (10, 10))
    colours = {"oldest": style.BLUE, "late-born": style.ORANGE, "founders": style.SOFT}
    for group, colour in colours.items():
        lived = np.concatenate([bed.reborn for bed in beds() if bed.group == group])
        (curve,) = (each for each in again.get_lines() if each.get_color() == colour)
        assert curve.get_drawstyle() == "steps-pre", "the share falls after the end of a life"
        x, y = (np.asarray(values, float) for values in curve.get_data())
        assert sorted(np.maximum(lived, 1).tolist()) == x.tolist()
        for life, share in zip(x, np.maximum.reduceat(y, np.searchsorted(x, x)), strict=True):
            assert share == pytest.approx((np.maximum(lived, 1) >= life).mean())
    assert labels(again)[1:] == ("life when born again (ticks)", "share that live at least as long")
    assert key(again) == colours
    assert key(pairs) == {name: colours[name] for name in ("oldest", "late-born")}


def test_a_strip_without_known_values_is_left_out_and_zeros_are_known() -> None:
    axes = Figure().subplots()
    assays.strips(axes, {"none": [None, np.nan], "zero": [0.0, None, 0.0], "one": [0.5]}, "")
    check_strips(axes, {"none": [], "zero": [0.0, 0.0], "one": [0.5]})


def test_heredity_is_drawn_as_strips_of_the_worlds() -> None:
    """The second world has too few copies. In the fourth nothing was measured."""

    def pairs(slope: float | None) -> Pairs:
        return Pairs(9, slope, 0.5, 0.25, 0.125) if slope else Pairs(0, None, None, None, None)

    found = [
        Inherited(0, pairs(0.1), pairs(0.2), pairs(0.3), 4.0, -2.0),
        Inherited(1, pairs(None), pairs(0.4), pairs(0.5), -1.0, 0.5),
        Inherited(2, pairs(0.6), pairs(0.7), pairs(0.8), 1.0, 0.0),
        Inherited(3, pairs(None), pairs(None), pairs(None), None, None),
    ]
    slopes, shares, terms = axes_of(assays.heredity, found)
    each = {"copies": [0.1, 0.6], "mutants": [0.2, 0.4, 0.7], "both": [0.3, 0.5, 0.8]}
    check_strips(slopes, each)
    of_mutants = {"as long": 0.5, "a tenth\nlonger": 0.25, "a third\nshorter": 0.125}
    check_strips(shares, {name: [share] * 3 for name, share in of_mutants.items()})
    check_strips(terms, {"selection": [4, -1, 1], "transmission": [-2, 0.5, 0]})
    assert (sorted(levels(slopes)), levels(terms)) == ([0, 1], [0])
    titles = "Slope of log life on the parent's", "Share of mutants", "Change of mean log life"
    assert [labels(axes)[0] for axes in (slopes, shares, terms)] == [*titles]
    assert all(key(axes) == WORLDS for axes in (slopes, shares, terms))


def test_the_threshold_is_drawn_as_strips_of_the_worlds() -> None:
    """Infinite values are not drawn. The dot of a single world lies in the middle of its strip."""
    found = [
        Threshold(0, 0.5, None, 3.0),
        Threshold(1, 0.25, 0.75, 2.0),
        Threshold(2, 0.125, None, np.inf),
        Threshold(3, 0.9, None, 10.0),
    ]
    shares, factors = axes_of(assays.threshold, found)
    check_strips(
        shares, {"p: children\nthat mutate": [0.5, 0.25, 0.125, 0.9], "v: mutants\nas good": [0.75]}
    )
    advantage = "s: advantage of\ngood lines"
    check_strips(factors, {advantage: [3, 2, 10], "s (1 - p (1 - v))": [2 * (1 - 0.25 * 0.25)]})
    assert levels(factors, style.VERMILION) == [1]
    assert factors.get_yscale() == "log"
    assert key(shares) == WORLDS
    assert key(factors) == {**WORLDS, "threshold": style.VERMILION}


def test_a_line_is_drawn_to_its_last_generation_with_both_lives_of_each_genome() -> None:
    def steps(*lives: tuple[int, int, float]) -> list[Step]:
        return [Step(n, 10 * n, 7 * n, "mutant", recorded, lived) for n, recorded, lived in lives]

    short = Line(40, 2, 5, 4, steps((0, 3, 0.0), (2, 0, 90.0), (3, 8, 95.0), (4, 9, 100.0)))
    single = Line(0, 1, 0, 1, steps((0, 5, 6.0)))
    one, other = axes_of(assays.line, [short, single])
    (born_again,) = (each for each in one.get_lines() if each.get_color() == style.BLUE)
    assert born_again.get_drawstyle() == "steps-post", "a genome lasts until the next"
    assert points(one, style.BLUE) == [(0, 1), (2, 90), (3, 95), (4, 100), (5, 100)]
    assert points(one, style.ORANGE) == [(0, 3), (2, 1), (3, 8), (4, 9)]
    assert [x for x, _ in points(one, style.FAINT)] == [2, 2], "as good from there on"
    assert points(other, style.BLUE) == [(0, 6), (0, 6)]
    assert (one.get_xlim(), other.get_xlim()) == ((0, 5), (0, 1))
    for axes, name in ((one, "organism 40 of world 2"), (other, "organism 0 of world 1")):
        assert labels(axes) == (f"The line of {name}", "generation", "ticks lived")
        assert axes.get_yscale() == "log"
        assert key(axes) == {
            "born again": style.BLUE, "as recorded": style.ORANGE, "as good from": style.SOFT
        }  # fmt: skip


def test_brains_and_bodies_of_a_line_are_drawn_apart() -> None:
    steps = [
        Step(n, 10 * n, 7 * n, "mutant", 4, 50, brain=brain, body=body)
        for n, (brain, body) in enumerate(((0, 30), (20, 40), (50, 50)))
    ]
    (axes,) = axes_of(assays.line, [Line(20, 0, 2, 3, steps)])
    assert points(axes, style.GREEN) == [(0, 1), (1, 20), (2, 50)]
    assert points(axes, style.VERMILION) == [(0, 30), (1, 40), (2, 50)]
    assert key(axes)["body with the last brain"] == style.VERMILION
    assert key(axes)["brain in the last body"] == style.GREEN
