"""Births joined with deaths, and parents found, compared with the plainest method."""

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


def dictionary(codes: np.ndarray, names: type[BirthCause] | type[Cause]) -> pa.Array:
    return pa.DictionaryArray.from_arrays(codes.astype(np.int8), [each.label for each in names])


def tables(worlds: list[list[bool]], cuts: int) -> tuple[list[pa.Table], list[pa.Table]]:
    """Return births and deaths of worlds in the order of events, in several segments."""
    rows = [
        (n, w) for w, there in enumerate(worlds) for n, on_record in enumerate(there) if on_record
    ]
    number, world = np.array(sorted(rows), np.int64).reshape(-1, 2).T
    parent, causes = (number - 1) // 2, np.minimum(number, 2)
    births = pa.table(
        {
            "world": world.astype(np.int32),
            "id": number,
            "parent": pa.array(parent, mask=parent == -1),
            "tick": 10 * number,
            "cell": (number % 7).astype(np.int32),
            "cause": dictionary(causes, BirthCause),
        }
    )
    dead = np.flatnonzero(number % 3 > 0)[::-1]
    died = {"world": births["world"].take(dead), "id": number[dead], "tick": 10 * number[dead] + 5}
    deaths = pa.table({**died, "cause": dictionary(number[dead] % 3, Cause)})
    size = len(births) // cuts + 1
    return tuple([each.slice(at * size, size) for at in range(cuts)] for each in (births, deaths))  # type: ignore[return-value]


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
