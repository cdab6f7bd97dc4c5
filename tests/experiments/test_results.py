"""The files of results: their tables, their order, and the last line with the day and the versions."""

import csv
import os
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import ANY, MagicMock

import numpy as np
import pytest

from primordia.comparison.comparison import ComparedArm
from primordia.comparison.measured import Measured
from primordia.comparison.tables import effects
from primordia.experiments import results
from primordia.history.extinctions import Extinctions
from primordia.runs.arrays import NEVER
from primordia.runs.directory import VERSIONS
from tests.comparison.arms import side_by_side

NOON = 1_700_000_000 + 12 * 3600
DAY = 24 * 3600
WHAT: dict[str, Any] = {"survival": None, "pace": None, "gathering": None, "extinctions": None}


def arm(name: str, births: list[float], unsaturated: int, **other: list[float]) -> ComparedArm:
    """Return an arm whose last worlds are not saturated; outcomes not named are unknown."""
    worlds, known = len(births), np.arange(len(births)) < len(births) - unsaturated
    none = Measured(np.ones(worlds), np.zeros(worlds, bool))
    measured = dict.fromkeys(
        ("first", "births", "ticks", "lifespan", "longest", "pace", "food"), none
    )
    measured |= {name: Measured(np.array(births), known) for name in ("births", "ticks")}
    measured |= {key: Measured(np.array(each), np.isfinite(each)) for key, each in other.items()}
    seeds = np.arange(worlds, dtype=np.uint64) + np.uint64(len(name))
    return ComparedArm(name, {"hazard": len(name) / 10}, seeds, measured, **WHAT)


ONE = arm("one", [10, 20, 30, 40, 50], 1, lifespan=[4, 5, 6, 7, 8])
THREE = arm("three", [100, 200, 300, 400, 500, 600], 0, lifespan=[2, 3, 4, 5, 6, 6])
FOUR = arm("four", [1, 2, 3], 0, lifespan=[9, 9, 9])


def rows_of(text: str) -> list[list[str]]:
    """Return the cells of a table in Markdown."""
    lines = [line.strip("|").split("|") for line in text.splitlines()]
    assert set(map(str.strip, lines[1])) == {"---"}
    assert len({len(line) for line in lines}) == 1
    return [[cell.strip() for cell in line] for line in (lines[0], *lines[2:])]


def test_the_counts_of_a_world_are_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two worlds of three cells."""
    names = "tick", "births", "saturated_births", "saturated"
    state = {
        f"world.worlds.{name}": np.array([10 * place, 10 * place + 1], np.uint64)
        for place, name in enumerate(names, 1)
    }
    records: Any = SimpleNamespace(
        world_seeds=np.array([7, 8]),
        count=state.__getitem__,
        state={"world.organisms.alive": np.array([1, 1, 1, 0, 0, 1], bool)},
    )
    lost = Extinctions(np.array([30, 31]), np.array([5, 6]))
    monkeypatch.setattr(results, "extinctions_of", lambda arm: lost if arm is records else None)
    found = {name: column.tolist() for name, column in results.counts(records).items()}
    assert found == {
        "seed": [7, 8], "ticks": [10, 11], "births": [20, 21], "extinctions": [30, 31],
        "crashes": [5, 6], "alive": [3, 1], "saturated_births": [30, 31], "saturated_tick": [40, 41],
    }  # fmt: skip


def test_the_summary_has_a_row_for_each_arm() -> None:
    """Of 1, 2, 3, 4 and 90 extinctions, the median is 3."""
    counted = [
        {"extinctions": np.array([90, 1, 3, 2, 4]), "crashes": np.array([0, 2, 0, 1, 0])},
        {"extinctions": np.array([0, 0, 5, 5, 0, 9]), "crashes": np.array([0, 0, 0, 0, 0, 7])},
        {"extinctions": np.array([0, 0, 0]), "crashes": np.array([0, 0, 0])},
    ]
    head, *rows = rows_of(results.summary(side_by_side(ONE, THREE, FOUR), counted))
    assert head[:6] == ["", "hazard", "worlds", "saturated", "extinctions (median)", "crashes"]
    assert head[6:] == ["births to saturation", "ticks to saturation", "mean lifespan"]
    assert [row[:6] for row in rows] == [
        ["one", "0.3", "5", "4", "3", "3 in 2 worlds"],
        ["three", "0.5", "6", "6", "2.5", "7 in 1 world"],
        ["four", "0.4", "3", "3", "0", "0"],
    ]
    assert [row[6:] for row in rows] == [
        ["30 (20 to 40)", "30 (20 to 40)", "6 (5 to 7)"],
        ["300 (200 to 500)", "300 (200 to 500)", "4 (3 to 6)"],
        ["2 (1 to 3)", "2 (1 to 3)", "9"],
    ]


def test_each_arm_is_compared_with_the_first() -> None:
    """Of the 30 pairs with arm `three`, its lives are longer in 5, equal in 4 and shorter in 21."""
    whole = side_by_side(ONE, THREE, FOUR)
    head, *rows = rows_of(results.table(*effects(whole)))
    assert head == ["against one", *whole.outcomes.values()]
    assert [row[0] for row in rows] == ["three", "four"]
    pairs = [(one, three) for one in (4, 5, 6, 7, 8) for three in (2, 3, 4, 5, 6, 6)]
    more, fewer = sum(b > a for a, b in pairs), sum(b < a for a, b in pairs)
    needs = "0.667; needs 23 worlds an arm"
    assert rows[0][3] == f"{(more - fewer) / 30:+.2f} large shorter; {needs}"
    assert rows[1][3] == "+1.00 longer; 1.5"
    assert rows[1][1] == "-1.00 earlier; 0.0667"


def test_arms_with_the_same_seeds_have_effects_within_seeds() -> None:
    other = arm("two", [20, 30, 40, 50, 60], 0, lifespan=[5, 6, 7, 8, 9])
    (row,) = rows_of(results.table(*effects(side_by_side(ONE, other))))[1:]
    delta = sum(np.sign(b - a) for a in (4, 5, 6, 7, 8) for b in (5, 6, 7, 8, 9)) / 25
    assert row[3].startswith(f"{delta:+.2f} medium longer; within seeds +1.00; 1.17 (")


def test_last_deaths_have_a_median_and_quartiles_over_the_worlds_of_each_arm() -> None:
    ends = [
        [{"late_deaths": count, "late_lifespan": 10.0 * count} for count in counts]
        for counts in ((8, 0, 2), (5,))
    ]
    head, *rows = rows_of(results.dying(side_by_side(ONE, THREE), ends))
    assert head == ["", "deaths in the last quarter", "their median lifespan"]
    assert rows == [["one", "2 (1 to 5)", "20 (10 to 50)"], ["three", "5", "50"]]


def test_the_csv_has_a_row_for_each_world_and_an_empty_cell_for_the_unknown() -> None:
    """The arms have different numbers of worlds. Values have two decimals, and four digits at least."""
    nan = float("nan")
    one = arm("one", [10, 20], 1, lifespan=[4.00649, nan], food=[70, 0.0123456])
    two = arm("two", [30], 0, lifespan=[1000 / 3], food=[12345678])
    counted = [
        {"seed": np.array([3, 4]), "saturated_tick": np.array([NEVER, 9], np.uint64)},
        {"seed": np.array([5]), "saturated_tick": np.array([0], np.uint64)},
    ]
    text = results.world_rows(side_by_side(one, two), counted, [])
    assert list(csv.reader(text.splitlines())) == [
        ["arm", "seed", "saturated_tick", "mean_lifespan", "late_food"],
        ["one", "3", "", "4.006", "70"],
        ["one", "4", "9", "", "0.01235"],
        ["two", "5", "0", "333.33", "12345678"],
    ]
    ends = [
        [{"late_deaths": 0.0, "late_lifespan": nan}, {"late_deaths": 2.0, "late_lifespan": 0.5}],
        [{"late_deaths": nan, "late_lifespan": 3.0}],
    ]
    text = results.world_rows(side_by_side(one, two), counted, ends)
    assert [row[-2:] for row in csv.reader(text.splitlines())] == [
        ["late_deaths", "late_lifespan"], ["0.0", ""], ["2.0", "0.5"], ["", "3.0"]
    ]  # fmt: skip


@pytest.mark.parametrize("saturate", [True, False])
def test_the_parts_of_the_page_are_in_order_and_have_each_arm(
    saturate: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The page has last deaths only if the worlds do not saturate."""
    births, missing = [10.0, 20, 30], 0 if saturate else 3
    arms = [
        arm(name, births, missing, lifespan=births, pace=[float(place)] * 3)
        for place, name in enumerate(("one", "three"), 1)
    ]
    whole = side_by_side(*arms)
    none = np.zeros(3, int)
    counted = {
        name: {"extinctions": none + place, "crashes": none} for place, name in enumerate("ab", 1)
    }
    ends = {name: [{"late_deaths": place}] * 3 for place, name in enumerate("ab", 1)}
    figure = MagicMock()
    figure.savefig.side_effect = lambda file, **_: Path(file).touch()
    for name, value in {
        "compare": lambda records: whole,
        "counts": counted.__getitem__,
        "made": lambda names, records: f"made {names} {records}",
        "draw": lambda found: figure if found is whole else None,
        "late.last_deaths": lambda record, found: ends[record],
    }.items():
        monkeypatch.setattr(f"primordia.experiments.results.{name}", value)
    records: Any = ["a", "b"]
    paths = results.write(tmp_path / "results", "Is it?", records)
    assert paths == [tmp_path / f"results.{suffix}" for suffix in ("md", "csv", "png")]
    title, picture, summary, *others, effects, note, made = paths[0].read_text().split("\n\n")
    assert picture == "![The arms side by side](results.png)"
    assert (title, made) == ("# Is it?", "made ['one', 'three'] ['a', 'b']\n")
    assert note.startswith(" ".join([*results.NOTES, results.OF_EFFECTS]))
    assert [row[4] for row in rows_of(summary)[1:]] == ["1", "2"]
    assert [rows_of(other)[1:] for other in others] == (
        [] if saturate else [[["one", "1"], ["three", "2"]]]
    )
    assert rows_of(effects)[0][0] == "against one"
    last = [line.rpartition(",")[2] for line in paths[1].read_text().splitlines()]
    assert saturate or last == ["late_deaths", *"111222"]
    figure.savefig.assert_called_once_with(ANY, dpi=200, format="png")


def begun(folder: Path, name: str, day: int, version: str, **limits: int | None) -> Any:
    """Return what `made` reads of an arm of two runs; the second run began a day earlier."""
    paths = []
    for number in range(2):
        file = folder / f"{name}-{number}" / VERSIONS
        file.parent.mkdir()
        file.touch()
        os.utime(file, (NOON + (day - number) * DAY,) * 2)
        paths.append(file.parent)
    progress = SimpleNamespace(limits=list(limits.items()))
    return SimpleNamespace(paths=paths, versions={"jax": version}, progress=progress)


def test_the_last_line_names_the_arms_where_they_differ(tmp_path: Path) -> None:
    arms = [
        begun(tmp_path, "a", 0, "1", ticks=500),
        begun(tmp_path, "b", 0, "1, 2", ticks=900),
        begun(tmp_path, "c", 0, "1", ticks=500),
    ]
    assert results.made("abc", arms) == (
        "Run on 2023-11-14 with jax 1 (a, c); jax 1, 2 (b)."
        " Each world stopped at: ticks 500 (a, c); ticks 900 (b)."
    )


def test_the_last_line_gives_what_all_arms_share_once(tmp_path: Path) -> None:
    arms = [
        begun(tmp_path, "a", 3, "1", ticks=500, births=None, until=40),
        begun(tmp_path, "b", 1, "1", ticks=500, births=None, until=40),
    ]
    line = "Run on 2023-11-15 with jax 1. Each world stopped at: ticks 500 or until 40."
    assert results.made("ab", arms) == line
