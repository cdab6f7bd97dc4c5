"""Tables on the terminal, and medians with quartiles in them."""

import re

import pytest

from primordia.cli.table import show_table, spread


def test_a_table_has_names_on_the_left_and_numbers_on_the_right(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also on a terminal with colours, a table has only plain characters."""
    monkeypatch.setenv("FORCE_COLOR", "1")
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
    assert spread([0, None, 0.0, 4]) == "0 (0 to 2)"
    assert spread([None]) == spread([]) == "-"
