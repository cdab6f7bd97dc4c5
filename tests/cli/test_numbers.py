"""Numbers as values of options, and numbers in tables."""

import re

import click
import pytest

from primordia.cli.numbers import COUNT, TICKS, Finite
from primordia.cli.table import show_table, spread


@pytest.mark.parametrize(
    ("kind", "least", "most"),
    [(TICKS, 1, 2_147_483_647), (COUNT, 1, 65_536)],
    ids=["ticks", "count"],
)
def test_bounds_are_the_last_numbers_that_are_taken(
    kind: click.IntRange, least: int, most: int
) -> None:
    for number in (least, most):
        assert kind.convert(str(number), None, None) == number
    for number in (least - 1, most + 1):
        with pytest.raises(click.BadParameter, match=str(number)):
            kind.convert(str(number), None, None)


def test_a_finite_number_is_a_number_in_its_range() -> None:
    kind = Finite(min=0, min_open=True, max=3)
    assert [kind.convert(text, None, None) for text in ("1e-9", "2", "3")] == [1e-9, 2.0, 3.0]
    for text in ("0", "3.1", "nan", "inf", "-inf", "x"):
        with pytest.raises(click.BadParameter, match=text):
            kind.convert(text, None, None)
    with pytest.raises(click.BadParameter, match="'inf' is not a finite number"):
        Finite().convert("inf", None, None)


def test_a_table_has_names_on_the_left_and_numbers_on_the_right(
    capsys: pytest.CaptureFixture[str],
) -> None:
    show_table(
        "Lives", ("", "age", "kept"), [("first", "7", "1 %"), ("no", "12,345", "-")], ["Note."]
    )
    assert [line.rstrip() for line in capsys.readouterr().out.splitlines()] == [
        "Lives",
        "",
        "            age   kept",
        " ─────────────────────",
        " first        7    1 %",
        " no      12,345      -",
        "",
        "Note.",
    ]


def test_no_number_of_a_wide_table_is_cut(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    numbers = [f"{n * 11} ({n} to {n * 99})" for n in range(1, 8)]
    show_table("Wide", ["name", *numbers], [["one", *reversed(numbers)]])
    lines = capsys.readouterr().out.splitlines()
    assert [re.split(" {2,}", line.strip()) for line in lines if "(" in line] == [
        ["name", *numbers], ["one", *reversed(numbers)],
    ]  # fmt: skip


def test_a_spread_is_the_median_with_both_quartiles_of_the_known_values() -> None:
    """Of 1, 2, 4, 8 and 100 the quartiles are 2 and 8, and the mean would be 23."""
    assert spread([100, None, 1, 8, 2, float("nan"), 4]) == "4 (2 to 8)"
    assert spread([None, 3.0]) == "3"
    assert spread([None]) == spread([]) == "-"
