"""The numbers of the view, each in its place with its unit; the bar of saturation; and the keys."""

from typing import Any

import pytest
from rich.segment import Segment

from primordia.live.panel import (
    Outlook,
    duration,
    heading,
    numbers,
    panel,
    saturation,
    with_prefix,
)
from tests.live.drawn import text
from tests.live.posed import counted
from tests.worlds import MEADOW, config

PACE = "at most 3 ticks/s"


@pytest.mark.parametrize(
    ("topology", "worlds", "size", "shape"),
    [
        ("ring", 1, "seed 7, 1,024 cells", "on a ring"),
        ("torus4", 1, "seed 7, 1,024 cells", "on a torus"),
        ("torus8", 3, "3 worlds, seeds 7 to 9, 1,024 cells each", "on a torus"),
        ("well-mixed", 1000, "1,000 worlds, seeds 7 to 1006, 1,024 cells each", "well-mixed"),
    ],
)
def test_the_heading_has_the_size_of_the_run_and_its_seeds(
    topology: str, worlds: int, size: str, shape: str
) -> None:
    """The shape is left out where there is no room; the task and the time are always shown."""
    of = config(MEADOW, seed=7, cells=1024, seeds=worlds, placement={"topology": topology})
    clock = f"{PACE}, 1 min 5 s"
    whole = f"meadow  {size} {shape}  {clock}"
    assert text([heading(of, PACE, 65.0, len(whole))]) == [whole]
    gap = " " * len(f" {shape} ")
    assert text([heading(of, PACE, 65.0, len(whole) - 1)]) == [f"meadow  {size}{gap}{clock}"]
    assert text([heading(of, "", 65.0, 12)]) == ["meadow 1 min 5 s"]


COUNTS: dict[str, Any] = {
    "tick": [1200, 3400],
    "alive": [5, 20],
    "births": [1000, 234],
    "deaths": [[7, 0, 30, 0, 0, 0, 0], [2, 0, 0, 900, 0, 30, 0]],
    "extinctions": [1, 2],
    "mean_age": 1234.6,
    "oldest": 2345,
}


def test_each_number_is_that_of_all_worlds_that_are_shown() -> None:
    found = numbers(counted(2, **COUNTS), 16, Outlook(4500.0, 125.0), 6)
    assert list(found.items()) == [
        ("tick", "3,400"),
        ("alive", "25 of 32"),
        ("mean age", "1,235"),
        ("births", "1,234"),
        ("deaths", "969"),
        ("oldest", "2,345"),
        ("organism-ticks/s", "4.5 k"),
        ("time left", "2 min 5 s"),
        ("takeovers", "6"),
        ("extinctions", "3"),
    ]


def test_unknown_numbers_are_left_out_and_zeros_are_not() -> None:
    found = numbers(counted(1), 8, Outlook(None, None), None)
    assert found == {
        "tick": "0", "alive": "0 of 8", "mean age": "0", "births": "0", "deaths": "0", "oldest": "0",
        "organism-ticks/s": "-", "extinctions": "0",
    }  # fmt: skip
    assert numbers(counted(1), 8, Outlook(0.0, 0.0), 0) == {
        **found, "organism-ticks/s": "0", "takeovers": "0",
    }  # fmt: skip


def test_from_a_million_cells_on_numbers_are_short() -> None:
    for cells, shown in ((499_999, "25 of 999,998"), (500_000, "25 of 1.0 M")):
        found = numbers(counted(2, **COUNTS), cells, Outlook(None, None), None)
        assert found["alive"] == shown


def test_at_most_five_numbers_stand_side_by_side_in_columns() -> None:
    values, census = {f"name{n}": f"{n}" for n in range(7)}, counted(1)
    for width, across in ((25, 1), (51, 1), (52, 2), (77, 2), (78, 3), (130, 5), (400, 5)):
        rows = text(panel(values, census, [], width, 20))[:-2]
        assert [row.split() for row in rows] == [
            [part for n in range(at, min(at + across, 7)) for part in (f"name{n}", f"{n}")]
            for at in range(0, 7, across)
        ]
        assert max(map(len, rows)) <= width
        if across > 1:
            column = min(width // across, 32)
            assert [row.index("name") for row in rows] == [0] * len(rows)
            assert rows[0].index("name1") == column
            assert rows[0].rindex("1", 0, 2 * column) == 2 * column - 4, "values end in one column"


def test_the_rows_of_numbers_are_cut_before_the_causes_and_the_bar() -> None:
    values, bar = {f"name{n}": f"{n}" for n in range(5)}, [Segment("the bar")]
    for height, kept in ((9, 5), (7, 5), (6, 4), (3, 1)):
        rows = text(panel(values, counted(1), bar, 26, height))
        assert [row.split()[0] for row in rows[:-2]] == [f"name{n}" for n in range(kept)]
        assert rows[-2:] == ["died of  nothing yet", "the bar"]
    assert len(panel(values, counted(1), bar, 26, 2)) == 2
    assert text(panel(values, counted(1), bar, 26, 1))[0].split() == ["name0", "0"]


def test_causes_of_death_of_all_worlds_are_ordered_by_their_counts() -> None:
    (row, _) = text(panel({}, counted(2, **COUNTS), [], 80, 9))
    assert row == "died of  900 replaced, 30 time-limit, 30 hazard, 9 fatal"


@pytest.mark.parametrize(
    ("counts", "width", "filled", "length", "shown"),
    [
        ({"saturated": [1234]}, 36, 8, 8, "saturated since tick 1,234"),
        ({"saturated": [1234]}, 35, 0, 0, "saturated since tick 1,234"),
        ({"saturated": [-1, 0, -1, -1]}, 80, 6, 24, "1 of 4 worlds saturated"),
        ({"saturated": [0, 60, 70, 80]}, 80, 24, 24, "4 of 4 worlds saturated"),
        ({"alive": [7], "calm": [500]}, 80, 0, 24, "calm: 0 of 1,000 ticks"),
        ({"alive": [8], "calm": [500]}, 80, 12, 24, "calm: 500 of 1,000 ticks"),
        ({"alive": [8], "calm": [2000]}, 80, 24, 24, "calm: 1,000 of 1,000 ticks"),
        ({"alive": [7, 8], "calm": [900, 250]}, 80, 6, 24, "calmest: 250 of 1,000 ticks"),
    ],
)
def test_the_bar_has_the_share_of_saturated_worlds_or_the_calm_of_full_worlds(
    counts: dict[str, list[int]], width: int, filled: int, length: int, shown: str
) -> None:
    """The bar has 8 to 24 columns; where there is no room for it, there are only words."""
    some = counted(len(next(iter(counts.values()))), **counts)
    bar = f"{'━' * filled}{'╌' * (length - filled)}  " if length else ""
    assert text([saturation(some, 8, 1000, width)]) == [f"{bar}{shown}"]


@pytest.mark.parametrize(
    ("number", "shown"),
    [(0.4, "0"), (999, "999"), (999.7, "1.0 k"), (99_900, "99.9 k"), (99_960, "100 k"),
     (12.34e6, "12.3 M"), (1e9, "1.0 G"), (2.5e12, "2500 G")],
)  # fmt: skip
def test_a_prefix_stands_for_each_thousand(number: float, shown: str) -> None:
    assert with_prefix(number) == shown


@pytest.mark.parametrize(
    ("seconds", "shown"),
    [(59.4, "59 s"), (59.6, "1 min 0 s"), (3599.4, "59 min 59 s"), (3599.6, "1 h 0 min"),
     (3.6e6 + 61, "1,000 h 1 min")],
)  # fmt: skip
def test_a_duration_has_its_two_largest_units(seconds: float, shown: str) -> None:
    assert duration(seconds) == shown
