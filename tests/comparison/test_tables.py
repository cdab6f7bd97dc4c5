"""A comparison as text: each number and word of the tables."""

import tomllib
from typing import Any

import numpy as np
import pytest

from primordia.comparison import tables
from primordia.comparison.contrast import Contrast, contrast
from primordia.comparison.measured import Measured
from primordia.comparison.pairs import Paired
from tests.comparison.arms import arm, side_by_side

INF = float("inf")


def cells(line: str) -> list[str]:
    """Return the cells of a row of a table."""
    return [cell.strip() for cell in line.strip().split("   ") if cell.strip()]


def effect(**changed: Any) -> Contrast:
    values: dict[str, Any] = {
        "delta": 0.4, "decided": 1.0, "paired": None, "ratio": (2.0, 2.0), "coverage": 0.95,
        "interval": (1.5, 3.0), "worlds": 9, **changed,
    }  # fmt: skip
    return Contrast(**values)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0, "0"), (0.12345, "0.123"), (2.0, "2"), (2.345, "2.35"), (99.96, "100"), (99.4, "99.4"),
        (100.4, "100"), (-100.6, "-101"), (-0.5, "-0.5"), (999_700, "999,700"), (1234.5, "1,234"),
        (INF, "inf"),
    ],
)  # fmt: skip
def test_numbers_have_three_digits_or_more(value: float, text: str) -> None:
    assert tables.number_text(value) == text


@pytest.mark.parametrize(
    ("bounds", "text"),
    [
        ((2, 2), "2"), ((2, 3.5), "2..3.5"), ((1200, INF), ">= 1,200"), ((0, INF), "unknown"),
        ((0, 0), "0"), ((0, 3.5), "0..3.5"),
    ],
)  # fmt: skip
def test_bounds_are_given_as_far_as_they_are_known(bounds: tuple[float, float], text: str) -> None:
    assert tables.bounds_text(bounds) == text
    assert tables.ratio_text(effect(ratio=bounds, interval=None)) == text
    assert tables.ratio_text(effect(ratio=bounds, interval=(0.5, INF))) == f"{text} (0.5 to inf)"


def test_quartiles_of_worlds_follow_the_median() -> None:
    """Quartiles of an outcome are values of worlds; those of other numbers may lie between."""
    worlds = [9, 1, 7, 3, 5, 8, 2]
    assert tables.quartiles_text(arm("one", worlds), "births") == "5 (2 to 8)"
    known = [True] * 5 + [False] * 2
    assert (
        tables.quartiles_text(arm("one", [4, 1, 2, 3, 5, 8, 9], known), "births") == "4 (2 to >= 8)"
    )
    assert tables.quartiles_text(arm("one", [4, 4, 4]), "lifespan") == "400"
    for worlds, text in (([4, 4, 4, 9, 9], "4 (4 to 9)"), ([1, 1, 4, 4, 4], "4 (1 to 4)")):
        assert tables.quartiles_text(arm("one", worlds), "births") == text
        assert tables.spread_text(worlds) == text
    assert tables.spread_text([9, 1, float("nan"), 3, 6]) == "4.5 (2.5 to 6.75)"
    assert tables.spread_text([3.0, 3.0]) == "3"
    assert tables.spread_text([0.0, 4.0, 0.0]) == "0 (0 to 2)"
    assert tables.spread_text([0.0]) == "0"
    assert tables.spread_text([float("nan")]) == tables.spread_text([]) == "-"


@pytest.mark.parametrize(
    ("outcome", "smaller", "larger"),
    [
        ("first", "earlier", "later"), ("births", "earlier", "later"), ("ticks", "earlier", "later"),
        ("lifespan", "shorter", "longer"), ("longest", "shorter", "longer"),
        ("pace", "fewer", "more"), ("food", "less", "more"),
    ],
)  # fmt: skip
def test_an_effect_has_its_direction(outcome: str, smaller: str, larger: str) -> None:
    assert tables.effect_text(effect(), outcome) == f"+0.40 medium {larger}"
    assert tables.effect_text(effect(delta=-0.5), outcome) == f"-0.50 large {smaller}"
    assert tables.effect_text(effect(delta=0.0), outcome) == "+0.00 negligible"
    few = effect(delta=-1.0, worlds=4, decided=0.999)
    assert tables.effect_text(few, outcome) == f"-1.00 {smaller}; order known in 99 % of pairs"


@pytest.mark.parametrize("pairs", [25, 900])
def test_the_share_of_pairs_is_given_in_whole_percent(pairs: int) -> None:
    """It is rounded down, so it is never 100 % if the order of some pairs is unknown."""
    for known in range(pairs):
        words = f"; order known in {100 * known // pairs} % of pairs"
        assert tables.effect_text(effect(decided=known / pairs), "births").endswith(words)


def test_pairs_and_needed_worlds_are_given_if_there_are_any() -> None:
    pairs = Paired(8, 6, 2)
    assert tables.paired_text(effect(paired=pairs)) == "+0.50"
    assert tables.paired_text(effect(paired=Paired(8, 3, 3))) == "+0.00"
    assert tables.paired_text(effect()) == ""
    assert tables.needed_text(effect(delta=0.02)) == f"{effect(delta=0.02).needed:,} worlds an arm"
    assert tables.needed_text(effect(delta=0.0)) == tables.needed_text(effect(worlds=4)) == ""


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "none"), (True, "true"), (False, "false"), (0, "0"), (2**64 - 1, f"{2**64 - 1}"),
        (0.5, "0.5"), (1e-05, "1e-05"), ("blind", "blind"), ([1, 0.5], "[1, 0.5]"),
        (["a", "b"], '["a", "b"]'), ([], "[]"),
    ],
)  # fmt: skip
def test_settings_are_given_as_flags_take_them(value: Any, text: str) -> None:
    assert tables.setting_text(value) == text
    if isinstance(value, bool | list):
        assert tomllib.loads(f"value = {text}") == {"value": value}


def test_the_first_table_has_settings_saturations_and_extinctions() -> None:
    one = arm("one", [1, 2, 3], [True, False, True], total=[5, 0, 4], crashes=[2, 0, 1])
    two = arm("two", [4, 5], seed=50, total=[1, 0], settings={"seed": 50, "a.b": None})
    one.settings.update({"seed": 0, "a.b": 0.5})
    plain = side_by_side(one, two).to_dict()["runs"]
    assert [(each["extinctions"], each["crashes"]) for each in plain] == [(9, 3), (1, 0)]
    head, _, *rows = tables.comparison_tables(side_by_side(one, two)).splitlines()[:4]
    assert cells(head) == ["meadow", "seed", "a.b", "worlds", "saturated", "extinctions", "crashes"]
    assert [cells(row) for row in rows] == [
        ["one", "0", "0.5", "3", "2", "9", "3 in 2 worlds"],
        ["two", "50", "none", "2", "2", "1", "0"],
    ]
    for horizons, words in (
        ({"births": 3000}, "saturated within 3,000 births"),
        ({"ticks": 40}, "saturated within 40 ticks"),
        ({"births": 3000, "ticks": 40}, "saturated within 3,000 births and 40 ticks"),
    ):
        text = tables.comparison_tables(side_by_side(one, two, **horizons))
        assert words in cells(text.splitlines()[0])


def test_each_run_is_in_a_row_below_the_reference() -> None:
    """Run `low` has the seeds of the reference. Run `far` has other seeds and a larger median."""
    arms = (
        arm("ref", [1, 2, 3, 4, 5, 6]),
        arm("low", [1, 1, 2, 3, 4, 5]),
        arm("far", [7] * 6, seed=9),
    )
    compared = side_by_side(*arms)
    lines = tables.comparison_tables(compared).splitlines()
    place = next(k for k, line in enumerate(lines) if "births to saturation" in line)
    title = "ratio of medians (95 % for all)"
    assert cells(lines[place]) == [
        "births to saturation", "median (quartiles)", "delta", "within seeds", title, "needs",
    ]  # fmt: skip
    low, far = (
        contrast(each.measured["births"], arms[0].measured["births"], None, 2) for each in arms[1:]
    )
    paired = compared.contrast(arms[1], "births")
    assert cells(lines[place + 2]) == ["ref", "3 (2 to 5)", "reference"]
    assert cells(lines[place + 3]) == [
        "low", "2 (1 to 4)", f"{low.delta:+.2f} small earlier", "-0.83",
        tables.ratio_text(paired), f"{paired.needed} worlds an arm",
    ]  # fmt: skip
    assert paired.ratio == (2 / 3, 2 / 3)
    assert cells(lines[place + 4]) == [
        "far", "7", "+1.00 large later", tables.ratio_text(far), f"{far.needed} worlds an arm",
    ]  # fmt: skip


def test_each_table_has_the_effects_of_its_own_outcome() -> None:
    """In each outcome, one more world of the second run has a larger value than in the one before."""
    ref, other = arm("ref", [10] * 5), arm("other", [10] * 5, seed=9)
    shares = {"first": 0, "births": 1, "ticks": 2, "lifespan": 3, "food": 4}
    for outcome, larger in shares.items():
        values = np.where(np.arange(5) < larger, 1e9, 0.001)
        other.measured[outcome] = Measured(values, np.ones(5, bool))
    compared = side_by_side(ref, other)
    assert list(compared.outcomes) == list(shares)
    lines = tables.comparison_tables(compared).splitlines()
    heads = [k for k, line in enumerate(lines) if "median (quartiles)" in line]
    assert [cells(lines[k])[0] for k in heads] == list(compared.outcomes.values())
    deltas = [cells(lines[k + 3])[2].split()[0] for k in heads]
    assert deltas == [f"{(2 * larger - 5) / 5:+.2f}" for larger in shares.values()]


def test_an_outcome_is_shown_if_it_is_known_in_any_world_of_any_run() -> None:
    one, two = arm("one", [1, 2, 3]), arm("two", [4, 5], seed=50)
    for known in ([0, 0, 0, 0, 0], [0, 1, 0, 0, 0], [0, 0, 0, 0, 1]):
        for each, of in ((one, known[:3]), (two, known[3:])):
            each.measured["first"] = Measured(np.ones(len(of)), np.array(of, bool))
        compared = side_by_side(one, two)
        assert ("first" in compared.outcomes) == any(known)
        text = tables.comparison_tables(compared)
        assert ("births to first long life" in text) == any(known)
