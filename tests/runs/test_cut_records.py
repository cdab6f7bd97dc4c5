"""Records that begin later or stop earlier, compared with loops over the lives of unequal worlds."""

from dataclasses import fields, replace

import numpy as np
import pytest

from primordia.errors import InputError
from primordia.runs.lives import ALIVE, Lives
from tests.synthetic import worlds_of

FIRST = [(0, 9, True), (0, 19, True), (5, 14, True), (10, 0, True), (20, 50, False), (21, 3, True)]
SECOND = [(0, 19, True), (20, 9, True), (30, 0, False)]
UNTIL = 40


@pytest.fixture
def lives() -> Lives:
    """Lives of three worlds, of which the middle one has none."""
    both = worlds_of(FIRST, SECOND, until=UNTIL)
    return replace(both, world=both.world * 2)


def rows(lives: Lives) -> list[dict[str, int]]:
    names = [each.name for each in fields(lives)]
    columns = (getattr(lives, name).tolist() for name in names)
    return [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)]


@pytest.mark.parametrize("tick", [0, 9, 10, 20, 40])
def test_a_fork_records_organisms_alive_at_its_tick_and_later_births(
    lives: Lives, tick: int
) -> None:
    expected = [
        {**life, "seen": max(life["born"], tick), "inherited": tick > 0 and life["born"] <= tick}
        for life in rows(lives)
        if life["cause"] == ALIVE or life["ended"] > tick
    ]
    assert rows(lives.recorded_since(tick)) == expected


def test_a_fork_of_a_fork_keeps_inherited_organisms(lives: Lives) -> None:
    later = lives.recorded_since(10).recorded_since(0)
    assert rows(later) == rows(lives.recorded_since(10))
    assert later.inherited.any()
    assert not later.inherited.all()


@pytest.mark.parametrize("tick", [0, 10, 20, 25, 41])
def test_a_stopped_record_holds_no_later_birth_and_no_later_death(lives: Lives, tick: int) -> None:
    """A death in the last tick is on record. An organism that dies later is alive at the end."""
    expected = [
        {**life, **({"ended": tick, "cause": ALIVE} if life["ended"] > tick else {})}
        for life in rows(lives)
        if life["born"] <= tick
    ]
    assert rows(lives.recorded_until(tick)) == expected
    assert lives.recorded_until(tick).cause.dtype == lives.cause.dtype


@pytest.mark.parametrize("tick", [0, 20])
def test_time_since_the_fork_is_counted_from_its_tick(lives: Lives, tick: int) -> None:
    fork = lives.recorded_since(tick)
    moved = ("born", "seen", "ended")
    expected = [life | {name: life[name] - tick for name in moved} for life in rows(fork)]
    assert rows(fork.since_fork()) == expected


def test_a_world_that_had_no_organism_at_the_fork_counts_from_the_same_tick() -> None:
    """In the first world, the first organism of the new record is born after the fork at 20."""
    fork = worlds_of([(0, 9, True), (23, 9, True)], [(0, 30, True)], until=UNTIL).recorded_since(20)
    since = fork.since_fork()
    assert fork.inherited.tolist() == [False, True]
    assert (since.born.tolist(), since.seen.tolist()) == ([3, -20], [3, 0])
    assert since.ended.tolist() == [13, 11]


def test_the_lives_of_one_world_are_taken_alone(lives: Lives) -> None:
    assert lives.worlds == 3
    assert rows(lives.of_world(0)) == [row for row in rows(lives) if row["world"] == 0]
    assert rows(lives.of_world(2)) == [row for row in rows(lives) if row["world"] == 2]
    assert len(lives.of_world(1)) == len(lives.of_world(3)) == 0
    assert lives.of_world(3).worlds == 0
    alone = lives.of_world(0)
    assert alone.of_world(0) is alone
    assert alone.worlds == 1
    assert lives.rank.tolist() == [*range(6), *range(3)]


@pytest.mark.parametrize(
    ("world", "says"),
    [(1, "nothing was born in world 1"), (3, "there is no world 3; the worlds are 0 to 2")],
)
def test_only_worlds_with_a_birth_have_an_oldest(lives: Lives, world: int, says: str) -> None:
    with pytest.raises(InputError, match=f"^{says}$"):
        lives.oldest(world)


def test_an_organism_is_found_in_its_own_world(lives: Lives) -> None:
    assert [lives.row(2, world) for world in (0, 2)] == [2, 8]
    for number, world in ((3, 2), (6, 0), (-1, 0), (0, 1), (0, 3)):
        with pytest.raises(InputError, match=f"^no organism {number} was born in world {world}$"):
            lives.row(number, world)
    wanted = np.array([2, 0, 2, 1, 0, 5]), np.array([2, 5, 3, 0, -1, 0])
    assert lives.rows_of(*wanted).tolist() == [8, 5, -1, -1, -1, -1]
