"""Births joined with deaths, and parents found, compared with the plainest method.

Births and deaths that contradict each other are named, and the last good value passes.
"""

from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from hypothesis import given
from hypothesis import strategies as st

from primordia.errors import InputError
from primordia.law.world import BirthCause, Cause
from primordia.runs.join import join
from primordia.runs.lives import ALIVE, Lives

WORLDS = st.lists(st.lists(st.booleans(), max_size=30), min_size=1, max_size=4)
"""Which birth numbers are on record in each world: all of them, except in a fork."""


FORK = 40
"""The tick of the fork with which all records begin."""


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


def tables(worlds: list[list[bool]], cuts: int) -> tuple[list[pa.Table], list[pa.Table]]:
    """Return births and deaths of worlds in the order of events, in several segments."""
    rows = [
        (n, w) for w, there in enumerate(worlds) for n, on_record in enumerate(there) if on_record
    ]
    births: dict[str, list[Any]] = {name: [] for name in BIRTHS}
    deaths: dict[str, list[Any]] = {name: [] for name in DEATHS}
    for number, world in sorted(rows):
        parent = (number - 1) // 2 if number else None
        cause = [*BirthCause][min(number, 2)].label
        row = (world, number, parent, 10 * number, number % 7, cause)
        for column, value in zip(births.values(), row, strict=True):
            column.append(value)
        if number % 3:
            row = (world, number, 10 * number + 5, [*Cause][number % 3].label)
            for column, value in zip(deaths.values(), row, strict=True):
                column.insert(0, value)
    size = len(rows) // cuts + 1
    whole = segment(births, BirthCause), segment(deaths, Cause)
    return tuple([each.slice(at * size, size) for at in range(cuts)] for each in whole)  # type: ignore[return-value]


def end(world: list[bool]) -> int:
    """Return a world's last tick, in which its youngest organism may die."""
    return 10 * len(world) - 5


def lives_of(worlds: list[list[bool]], cuts: int) -> Lives:
    births, deaths = tables(worlds, cuts)
    count = sum(map(len, births))
    return join(births, deaths, count, np.array([*map(end, worlds)]), FORK, 7)


@given(WORLDS, st.integers(1, 3))
def test_every_birth_with_its_death(worlds: list[list[bool]], cuts: int) -> None:
    lives = lives_of(worlds, cuts)
    expected = [(w, n) for w, there in enumerate(worlds) for n, here in enumerate(there) if here]
    assert list(zip(lives.world.tolist(), lives.id.tolist(), strict=True)) == expected
    for row, (world, number) in enumerate(expected):
        died = number % 3 > 0
        assert lives.ended[row] == (10 * number + 5 if died else end(worlds[world]))
        assert lives.cause[row] == (number % 3 if died else ALIVE)
        assert lives.parent[row] == (number - 1) // 2
        assert lives.birth_cause[row] == min(number, 2)
        assert (lives.born[row], lives.seen[row]) == (10 * number, max(10 * number, 40))
        assert lives.row(number, world) == row
        assert lives.rank[row] == sum(w == world for w, _ in expected[:row])


@given(WORLDS, st.integers(0, 2**30))
def test_parents_are_found_wherever_numbers_have_gaps(worlds: list[list[bool]], mask: int) -> None:
    lives = lives_of(worlds, 1)
    some = lives.take(np.array([bool(mask >> row % 30 & 1) for row in range(len(lives))], bool))
    where = {(w, n): row for row, (w, n) in enumerate(zip(some.world, some.id, strict=True))}
    expected = [where.get(each, -1) for each in zip(some.world, some.parent, strict=True)]
    assert some.parent_row.tolist() == expected


@given(WORLDS, st.floats(0, 0.99))
def test_the_oldest_is_the_last_of_the_longest_late_lives(
    worlds: list[list[bool]], after: float
) -> None:
    """Late are the births after a share of those of their world; those before a fork do not count."""
    lives = lives_of(worlds, 1)
    late: list[int] = []
    for world in dict.fromkeys(lives.world.tolist()):
        born = np.flatnonzero((lives.world == world) & (lives.born > FORK))
        here = born[int(after * len(born)) :].tolist()
        late += here
        if here:
            longest = max(lives.lifespan[here])
            equals = [row for row in here if lives.lifespan[row] == longest]
            assert lives.oldest(world, after) == equals[-1]
        else:
            with pytest.raises(InputError, match="nothing has been born since the fork"):
                lives.oldest(world, after)
    worlds_late = np.unique(lives.world[lives.late()]).tolist()
    assert lives.champions().tolist() == [lives.oldest(world) for world in worlds_late]
    assert np.flatnonzero(lives.late(after)).tolist() == late
    if late:
        longest = max(lives.lifespan[late])
        equals = [row for row in late if lives.lifespan[row] == longest]
        assert lives.oldest(None, after) == equals[-1]


@pytest.mark.parametrize("cuts", [1, 2])
def test_no_organism_dies_twice(cuts: int) -> None:
    """Neither in one segment of deaths nor in two."""
    births, deaths = tables([[True] * 12], 1)
    again = pa.concat_tables([*deaths, deaths[0].slice(0, 1)])
    size = len(again) // cuts + 1
    segments = [again.slice(at * size, size) for at in range(cuts)]
    with pytest.raises(ValueError, match="an organism dies twice"):
        join(births, segments, 12, np.array([end([True] * 12)]), 40, 7)


def changed(columns: dict[str, list[Any]], row: int, **values: Any) -> dict[str, list[Any]]:
    new = {name: list(each) for name, each in columns.items()}
    for name, value in values.items():
        new[name][row] = value
    return new


def few_lives_of(
    births: dict[str, list[Any]], deaths: dict[str, list[Any]], begins: int = 0
) -> Lives:
    return join(
        [segment(births, BirthCause)], [segment(deaths, Cause)], COUNT, ENDS.copy(), begins, CELLS
    )


@pytest.mark.parametrize(
    ("table", "row", "values", "fault"),
    [
        ("births", 1, {"world": 2}, "an organism lives in a world that does not exist"),
        ("births", 4, {"cell": CELLS}, "organism 3 lives in a cell that does not exist"),
        ("births", 4, {"cell": -1}, "organism 3 lives in a cell that does not exist"),
        ("births", 1, {"id": -1, "parent": -2}, "organism -1 has a birth number below 0"),
        ("births", 0, {"tick": -1}, "organism 0 is born before the first tick, or after the last"),
        ("births", 3, {"tick": 31}, "organism 2 is born before the first tick, or after the last"),
        ("births", 4, {"tick": 51}, "organism 3 is born before the first tick, or after the last"),
        ("births", 4, {"parent": 3}, "organism 3 is not younger than its parent"),
        ("births", 4, {"parent": None}, "organism 3 has no parent and is no founder"),
        ("births", 4, {"id": 1, "parent": 0}, "organism 1 is not recorded in order of birth"),
        ("births", 3, {"cause": "tired"}, "'tired' is not a cause"),
        ("deaths", 1, {"world": -1}, "an organism lives in a world that does not exist"),
        ("deaths", 1, {"id": 3}, "organism 3 dies without having been born"),
        ("deaths", 0, {"id": 2}, "organism 2 dies without having been born"),
        ("deaths", 0, {"tick": 9}, "organism 1 dies before its birth, or after the last tick"),
        ("deaths", 1, {"tick": 31}, "organism 0 dies before its birth, or after the last tick"),
    ],
)
def test_an_impossible_birth_or_death_is_named(
    table: str, row: int, values: dict[str, Any], fault: str
) -> None:
    tables = {"births": BIRTHS, "deaths": DEATHS}
    tables[table] = changed(tables[table], row, **values)
    with pytest.raises(ValueError, match=f"^{fault}$"):
        few_lives_of(tables["births"], tables["deaths"])


def test_the_first_and_the_last_tick_and_cell_are_possible() -> None:
    """Births and deaths may be in the last tick of a world. A death may be in the tick of birth."""
    births = changed(changed(BIRTHS, 3, tick=30), 4, tick=50, cell=CELLS - 1)
    deaths = changed(changed(DEATHS, 0, tick=50), 1, tick=0)
    lives = few_lives_of(births, deaths)
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
    lives = few_lives_of(BIRTHS, DEATHS, begins)
    for row, born in enumerate([0, 10, 40, 0, 20]):
        assert lives.seen[row] == max(born, begins)
        assert lives.entered[row] == max(begins - born, 0)
        assert lives.inherited[row] == (begins > 0 and born <= begins)


def test_without_deaths_all_are_alive() -> None:
    lives = join([segment(BIRTHS, BirthCause)], [], COUNT, ENDS.copy(), 0, CELLS)
    assert not lives.died.any()
    assert lives.ended.tolist() == [50, 50, 50, 30, 30]
