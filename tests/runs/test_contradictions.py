"""Births and deaths that contradict each other: each fault is named, and the last good value passes."""

from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from primordia.law.world import BirthCause, Cause
from primordia.runs.join import join
from primordia.runs.lives import ALIVE, Lives

ENDS = np.array([50, 30])
CELLS, COUNT = 4, 5
BIRTHS: dict[str, list[Any]] = {
    "world": [0, 1, 0, 1, 0],
    "id": [0, 0, 1, 2, 3],
    "parent": [None, None, 0, 0, 1],
    "tick": [0, 0, 10, 20, 40],
    "cell": [0, 3, 1, 0, 2],
    "cause": ["founder", "founder", "copy", "mutant", "mutant"],
}
DEATHS: dict[str, list[Any]] = {
    "world": [0, 1],
    "id": [1, 0],
    "tick": [30, 25],
    "cause": ["starved", "hazard"],
}


def segment(columns: dict[str, list[Any]], kind: type[BirthCause] | type[Cause]) -> pa.Table:
    types = {"world": pa.int32(), "cell": pa.int32()}
    arrays = {name: pa.array(columns[name], types.get(name, pa.int64())) for name in columns
              if name != "cause"}  # fmt: skip
    labels = [each.label for each in kind]
    labels += ["tired"] if "tired" in columns["cause"] else []
    codes = pa.array([labels.index(word) for word in columns["cause"]], pa.int8())
    return pa.table({**arrays, "cause": pa.DictionaryArray.from_arrays(codes, labels)})


def changed(columns: dict[str, list[Any]], row: int, **values: Any) -> dict[str, list[Any]]:
    new = {name: list(each) for name, each in columns.items()}
    for name, value in values.items():
        new[name][row] = value
    return new


def lives_of(births: dict[str, list[Any]], deaths: dict[str, list[Any]], begins: int = 0) -> Lives:
    return join(
        [segment(births, BirthCause)], [segment(deaths, Cause)], COUNT, ENDS.copy(), begins, CELLS
    )


@pytest.mark.parametrize(
    ("row", "values", "fault"),
    [
        (1, {"world": 2}, "an organism lives in a world that does not exist"),
        (4, {"cell": CELLS}, "organism 3 lives in a cell that does not exist"),
        (4, {"cell": -1}, "organism 3 lives in a cell that does not exist"),
        (1, {"id": -1, "parent": -2}, "organism -1 has a birth number below 0"),
        (0, {"tick": -1}, "organism 0 is born before the first tick, or after the last"),
        (3, {"tick": 31}, "organism 2 is born before the first tick, or after the last"),
        (4, {"tick": 51}, "organism 3 is born before the first tick, or after the last"),
        (4, {"parent": 3}, "organism 3 is not younger than its parent"),
        (4, {"parent": None}, "organism 3 has no parent and is no founder"),
        (4, {"id": 1, "parent": 0}, "organism 1 is not recorded in order of birth"),
        (3, {"cause": "tired"}, "'tired' is not a cause"),
    ],
)
def test_an_impossible_birth_is_named(row: int, values: dict[str, Any], fault: str) -> None:
    with pytest.raises(ValueError, match=f"^{fault}$"):
        lives_of(changed(BIRTHS, row, **values), DEATHS)


@pytest.mark.parametrize(
    ("row", "values", "fault"),
    [
        (1, {"world": -1}, "an organism lives in a world that does not exist"),
        (1, {"id": 3}, "organism 3 dies without having been born"),
        (0, {"id": 2}, "organism 2 dies without having been born"),
        (0, {"tick": 9}, "organism 1 dies before its birth, or after the last tick"),
        (1, {"tick": 31}, "organism 0 dies before its birth, or after the last tick"),
    ],
)
def test_an_impossible_death_is_named(row: int, values: dict[str, Any], fault: str) -> None:
    with pytest.raises(ValueError, match=f"^{fault}$"):
        lives_of(BIRTHS, changed(DEATHS, row, **values))


def test_the_first_and_the_last_tick_and_cell_are_possible() -> None:
    """Births and deaths may be in the last tick of a world. A death may be in the tick of birth."""
    births = changed(changed(BIRTHS, 3, tick=30), 4, tick=50, cell=CELLS - 1)
    deaths = changed(changed(DEATHS, 0, tick=50), 1, tick=0)
    lives = lives_of(births, deaths)
    assert lives.world.tolist() == [0, 0, 0, 1, 1]
    assert lives.id.tolist() == [0, 1, 3, 0, 2]
    assert lives.born.tolist() == [0, 10, 50, 0, 30]
    assert lives.ended.tolist() == [50, 50, 50, 0, 30]
    assert lives.cause.tolist() == [ALIVE, Cause.STARVED, ALIVE, Cause.HAZARD, ALIVE]
    assert lives.died.tolist() == [False, True, False, True, False]
    assert lives.parent.tolist() == [-1, 0, 1, -1, 0]
    assert lives.parent_row.tolist() == [-1, 0, 1, -1, 3]
    assert lives.cell.tolist() == [0, 1, 3, 3, 0]


@pytest.mark.parametrize("begins", [0, 10])
def test_lives_are_on_record_from_birth_or_from_the_fork(begins: int) -> None:
    """An organism that is born in the tick of the fork is alive at the fork."""
    lives = lives_of(BIRTHS, DEATHS, begins)
    for row, born in enumerate([0, 10, 40, 0, 20]):
        assert lives.seen[row] == max(born, begins)
        assert lives.entered[row] == max(begins - born, 0)
        assert lives.inherited[row] == (begins > 0 and born <= begins)


def test_without_deaths_all_are_alive() -> None:
    lives = join([segment(BIRTHS, BirthCause)], [], COUNT, ENDS.copy(), 0, CELLS)
    assert not lives.died.any()
    assert lives.ended.tolist() == [50, 50, 50, 30, 30]
